import "./whole_texts.css";

import { element } from "../dom";

const every_ms = 400; // a scope changes 60 times a second

/** What may be cut where it does not fit, but for readings, which change under the cursor and are said aloud. */
const cuttable = [
  ".recording_head h1",
  ".recording_facts",
  ".facts dd",
  ".overlay_name",
  ".file_name",
  ".preview_name",
  ".list_name",
  ".list_facts",
  ".mark_badge",
  ".palette_title",
  ".rendered",
  ".cycle_kinds",
].join(",");

const within = "a, button, label, summary, [tabindex='0']:not([data-cut])";

/**
 * What does not fit has its whole text as its title, and by the keyboard in a box below it: what is in a link or a button
 * where that has the focus, the rest by a stop of its own as long as it is cut. (A screen reader is told all anyway.)
 */
export function keepTextsWhole(): void {
  const box = element("div", { class: "whole_text", "aria-hidden": "true", hidden: true });
  document.body.append(box);
  let timer = 0;
  const soon = (): void => {
    timer ||= window.setTimeout(() => {
      timer = 0;
      for (const it of document.querySelectorAll<HTMLElement>(cuttable)) mark(it, isCut(it));
    }, every_ms);
  };
  const observer = new MutationObserver((changes) => changes.some((it) => it.target !== box) && soon());
  observer.observe(document.body, { childList: true, subtree: true, characterData: true });
  addEventListener("resize", soon);
  soon();

  const hide = (): void => void (box.hidden = true);
  document.addEventListener("focusin", ({ target }) => {
    hide();
    if (!(target instanceof HTMLElement) || !target.matches(":focus-visible")) return;
    const cut = [target, ...target.querySelectorAll<HTMLElement>(cuttable)].filter(
      (it) => it.matches(cuttable) && isCut(it),
    );
    if (cut.length === 0) return;
    const { left, bottom, top } = target.getBoundingClientRect();
    box.textContent = cut.map(wholeOf).join(" · ");
    box.hidden = false;
    const below = bottom + box.offsetHeight < innerHeight;
    box.style.left = `${Math.max(4, Math.min(left, innerWidth - box.offsetWidth - 4))}px`;
    box.style.top = `${Math.max(4, below ? bottom : top - box.offsetHeight)}px`;
  });
  document.addEventListener("focusout", hide);
  document.addEventListener("scroll", hide, true);
}

/** It, or what it is made of, ends in an ellipsis. */
function isCut(it: HTMLElement): boolean {
  return [it, ...it.querySelectorAll<HTMLElement>(":scope > span")].some(
    (part) => part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0,
  );
}

function wholeOf(it: HTMLElement): string {
  return it.textContent.trim();
}

function mark(it: HTMLElement, cut: boolean): void {
  if (cut) {
    const named = it.closest<HTMLElement>("[title]");
    if (!named?.title.includes(wholeOf(it))) it.title = wholeOf(it);
    if (it.closest(within) || it.tabIndex >= 0) return;
    it.tabIndex = 0;
    it.dataset.cut = "";
  } else if (it.dataset.cut !== undefined && it !== document.activeElement) {
    it.removeAttribute("tabindex");
    delete it.dataset.cut;
  }
}
