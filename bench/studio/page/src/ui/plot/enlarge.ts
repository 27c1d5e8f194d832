import { button } from "../dom";
import { isTyping } from "../keys";

const plots = ".card, figure, .time_stack"; // the least that a plot stands in with all that belongs to it

let large: HTMLElement | null = null;

/**
 * A button that gives the plot it stands in all of the window below the bar, where zero force stays within reach; the
 * same button, F on the plot, Escape, or going elsewhere gives it back its place.
 */
export function enlargeButton(): HTMLButtonElement {
  const opener = button("⤢", () => toggle(opener), {
    class: "small enlarge",
    "aria-label": "Enlarge the plot",
    "aria-pressed": "false",
    title: "The whole window for this plot, and back (F)",
  });
  return opener;
}

function toggle(opener: HTMLElement): void {
  const plot = opener.closest<HTMLElement>(plots);
  const isLarge = plot === large;
  giveBack();
  if (plot && !isLarge) enlarge(plot, opener);
}

/** On top of all that scrolls or cuts off what is in it, which a popover is; without its own way of closing. */
function enlarge(plot: HTMLElement, opener: HTMLElement): void {
  large = plot;
  const below = document.getElementById("bar")?.getBoundingClientRect().bottom ?? 0;
  plot.style.setProperty("--below_bar", `${below}px`);
  plot.classList.add("enlarged");
  plot.popover = "manual";
  plot.showPopover();
  opener.setAttribute("aria-pressed", "true");
  plot.addEventListener("focusout", goneElsewhere);
}

function giveBack(): void {
  if (!large) return;
  const focus = document.activeElement;
  large.removeEventListener("focusout", goneElsewhere);
  if (large.isConnected) large.hidePopover();
  large.popover = null;
  large.classList.remove("enlarged");
  large.querySelector(".enlarge")?.setAttribute("aria-pressed", "false");
  if (focus instanceof HTMLElement || focus instanceof SVGElement) focus.focus();
  large = null;
}

function goneElsewhere({ relatedTarget }: FocusEvent): void {
  const bar = document.getElementById("bar");
  if (relatedTarget instanceof Node && !large?.contains(relatedTarget) && !bar?.contains(relatedTarget)) giveBack();
}

addEventListener("keydown", (event) => {
  if (large && !large.isConnected) large = null; // its page has ended
  if (event.key === "Escape") return giveBack();
  if (event.key !== "f" || event.ctrlKey || event.altKey || event.metaKey || isTyping(event)) return;
  if (!(event.target instanceof Element)) return;
  const opener = event.target.closest(plots)?.querySelector<HTMLElement>(".enlarge");
  if (!opener) return;
  event.preventDefault();
  toggle(opener);
});
