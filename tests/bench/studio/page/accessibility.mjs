// What WCAG 2.1 AA asks of a page and a browser can check: audit(page) gives back a list of complaints, empty where
// all is well. `page` is playwright's. Call it again after each change of the page, and in light and dark.

/** Runs in the browser. */
function complaints() {
  const found = [];
  const say = (rule, node, what) => found.push(`${rule}: ${describe(node)}: ${what}`);

  function describe(node) {
    const name = node.tagName.toLowerCase();
    const id = node.id ? `#${node.id}` : "";
    const classes =
      typeof node.className === "string" && node.className ? `.${node.className.trim().replace(/\s+/g, ".")}` : "";
    const text = (node.textContent ?? "").trim().replace(/\s+/g, " ").slice(0, 40);
    return `<${name}${id}${classes}>${text ? ` "${text}"` : ""}`;
  }

  function visible(node) {
    if (!node.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true })) return false;
    const box = node.getBoundingClientRect();
    if (box.width <= 1 || box.height <= 1 || box.right <= 0) return false; // for screen readers only, or a skip link
    return !node.closest("[aria-hidden=true], .unseen");
  }

  // Contrast

  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const brush = canvas.getContext("2d", { willReadFrequently: true });
  function rgba(colour) {
    const parts = /^rgba?\(([\d.]+)[, ]+([\d.]+)[, ]+([\d.]+)(?:[,/ ]+([\d.]+%?))?\)$/.exec(colour);
    if (parts) {
      const alpha = parts[4] === undefined ? 1 : parts[4].endsWith("%") ? parseFloat(parts[4]) / 100 : Number(parts[4]);
      return [Number(parts[1]), Number(parts[2]), Number(parts[3]), alpha];
    }
    brush.clearRect(0, 0, 1, 1);
    brush.fillStyle = colour;
    brush.fillRect(0, 0, 1, 1);
    const [red, green, blue, alpha] = brush.getImageData(0, 0, 1, 1).data;
    return [red, green, blue, alpha / 255];
  }
  const over = ([r, g, b, a], [R, G, B]) => [r * a + R * (1 - a), g * a + G * (1 - a), b * a + B * (1 - a), 1];
  function luminance([red, green, blue]) {
    const linear = [red, green, blue].map((it) => {
      const share = it / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  }
  function contrast(a, b) {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  }
  /** What lies behind a node: its own ground and those of its parents, over each other. */
  function ground(node) {
    const layers = [];
    for (let it = node; it; it = it.parentElement) {
      const style = getComputedStyle(it);
      const colour = rgba(style.backgroundColor);
      if (colour[3] > 0) layers.push(colour);
      if (colour[3] === 1) break;
    }
    const canvasColour = matchMedia("(prefers-color-scheme: dark)").matches ? [18, 18, 18, 1] : [255, 255, 255, 1];
    return layers.reverse().reduce((under, layer) => over(layer, under), canvasColour);
  }
  function opacityOf(node) {
    let opacity = 1;
    for (let it = node; it; it = it.parentElement) opacity *= Number(getComputedStyle(it).opacity);
    return opacity;
  }
  function checkContrast(node) {
    const style = getComputedStyle(node);
    const inSvg = node instanceof SVGElement;
    const colour = rgba(inSvg ? style.fill : style.color);
    const under = ground(inSvg ? (node.ownerSVGElement ?? node) : node);
    colour[3] *= opacityOf(node) * (inSvg ? Number(style.fillOpacity) : 1);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const reached = contrast(over(colour, under), under);
    const needed = large ? 3 : 4.5;
    if (reached < needed - 0.005) say("contrast", node, `${reached.toFixed(2)} of ${needed}`);
  }
  const disabled = (node) => node.closest(":disabled, [aria-disabled=true], fieldset:disabled") !== null;
  const seen = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text = walker.nextNode(); text; text = walker.nextNode()) {
    const node = text.parentElement;
    if (!node || seen.has(node) || !text.data.trim() || /^(SCRIPT|STYLE|NOSCRIPT|OPTION|TITLE)$/i.test(node.tagName))
      continue;
    seen.add(node);
    if (visible(node) && !disabled(node)) checkContrast(node); // what is disabled is exempt (1.4.3)
  }
  for (const node of document.querySelectorAll("input, select, textarea")) {
    if (visible(node) && !disabled(node) && !["checkbox", "radio", "range", "color"].includes(node.type))
      checkContrast(node);
  }

  // Names

  function nameOf(node) {
    const byId = (node.getAttribute("aria-labelledby") ?? "").split(/\s+/).filter(Boolean);
    const labelled = byId
      .map((id) => document.getElementById(id)?.textContent ?? "")
      .join(" ")
      .trim();
    if (labelled) return labelled;
    const label = node.getAttribute("aria-label")?.trim();
    if (label) return label;
    const labels = [...(node.labels ?? [])].map((it) => it.textContent.trim()).filter(Boolean);
    if (labels.length > 0) return labels.join(" ");
    if (node instanceof SVGElement) return node.querySelector(":scope > title")?.textContent?.trim() ?? "";
    if (
      /^(button|a|summary)$/i.test(node.tagName) ||
      ["button", "link", "tab", "menuitem"].includes(node.getAttribute("role"))
    ) {
      const alternatives = [...node.querySelectorAll("img[alt], svg[aria-label]")];
      const other = alternatives.map((it) => it.getAttribute("alt") ?? it.getAttribute("aria-label"));
      return [node.textContent.trim(), ...other].join(" ").trim();
    }
    return node.getAttribute("title")?.trim() ?? "";
  }
  const named =
    "button, input:not([type=hidden]), select, textarea, a[href], summary, progress, meter, dialog[open], " +
    "[role=button], [role=slider], [role=application], [role=tab], [role=img], [role=tablist], svg.xy_plot, .time_focus, [tabindex='0']";
  for (const node of document.querySelectorAll(named)) {
    if (visible(node) && nameOf(node) === "") say("name", node, "has no accessible name");
  }
  for (const node of document.querySelectorAll("input, select, textarea")) {
    if (visible(node) && nameOf(node) === (node.getAttribute("placeholder") ?? NaN))
      say("name", node, "only a placeholder names it");
  }
  for (const canvasNode of document.querySelectorAll("canvas")) {
    if (!canvasNode.closest("[aria-hidden=true], [role=img], [role=application]"))
      say("name", canvasNode, "is neither hidden nor named");
  }
  const ids = new Map();
  for (const node of document.querySelectorAll("[id]")) ids.set(node.id, (ids.get(node.id) ?? 0) + 1);
  for (const [id, count] of ids) if (count > 1) found.push(`ids: ${count} elements are called ${id}`);
  for (const node of document.querySelectorAll("[aria-controls], [aria-labelledby], [aria-describedby]")) {
    for (const attribute of ["aria-controls", "aria-labelledby", "aria-describedby"]) {
      for (const id of (node.getAttribute(attribute) ?? "").split(/\s+/).filter(Boolean)) {
        if (!ids.has(id)) say("ids", node, `${attribute} names ${id}, which is not there`);
      }
    }
  }

  // Targets: at least 24 by 24 pixels, or as far from their neighbours; links within a sentence are exempt.

  const targets = [
    ...document.querySelectorAll(
      "button, input:not([type=hidden]), select, textarea, a[href], summary, [role=button], [role=slider], [role=tab]",
    ),
  ].filter((it) => visible(it) && !disabled(it));
  for (const node of targets) {
    const label = ["checkbox", "radio"].includes(node.type) ? node.closest("label") : null;
    const box = (label ?? node).getBoundingClientRect();
    const inSentence =
      node.tagName === "A" &&
      getComputedStyle(node).display === "inline" &&
      (node.parentElement?.textContent ?? "").trim() !== node.textContent.trim();
    if (!inSentence && (box.width < 23.5 || box.height < 23.5)) {
      say("target", node, `is ${box.width.toFixed(0)} by ${box.height.toFixed(0)} pixels`);
    }
  }

  // The page

  const heads = [...document.querySelectorAll("h1")].filter(visible);
  if (heads.length !== 1) found.push(`page: ${heads.length} visible h1`);
  if (!document.documentElement.lang) found.push("page: has no language");
  if (!document.title.trim()) found.push("page: has no title");
  if (document.querySelectorAll("main").length !== 1) found.push("page: does not have one main part");
  const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (wide > 0) found.push(`page: scrolls sideways by ${wide} pixels at ${innerWidth} x ${innerHeight}`);
  let level = 0;
  for (const head of document.querySelectorAll("main :is(h1, h2, h3, h4, h5, h6)")) {
    if (!visible(head)) continue;
    const own = Number(head.tagName[1]);
    if (own > level + 1) say("heads", head, `is of level ${own} after ${level}`);
    level = own;
  }
  return found;
}

/** What shows of a focus: the outline, the border, the shadow and the ground. */
function looks(node) {
  const style = getComputedStyle(node);
  const outline =
    style.outlineStyle === "none" || parseFloat(style.outlineWidth) === 0
      ? ""
      : `${style.outlineStyle} ${style.outlineColor} ${style.outlineWidth}`;
  const drawn = node instanceof SVGElement ? `${style.stroke} ${style.strokeWidth} ${style.fill}` : "";
  return [
    outline,
    style.borderColor,
    style.borderWidth,
    style.boxShadow,
    style.backgroundColor,
    style.textDecoration,
    drawn,
  ].join(" | ");
}

/** Goes through the page by the Tab key as a person does: what gets the focus must show it, and be seen. */
async function focusComplaints(page, at_most) {
  const found = [];
  await page.evaluate(() => {
    document.activeElement?.blur();
    getSelection()?.removeAllRanges();
    window.kerfAudited = new Set();
  });
  for (let step = 0; step < at_most; ++step) {
    await page.keyboard.press("Tab");
    const result = await page.evaluate((source) => {
      const node = document.activeElement;
      if (!node || node === document.body || window.kerfAudited.has(node)) return { end: true };
      window.kerfAudited.add(node);
      const look = new Function(`return (${source})`)();
      const name = `<${node.tagName.toLowerCase()}${node.id ? `#${node.id}` : ""}> "${(node.getAttribute("aria-label") ?? node.textContent ?? "").trim().slice(0, 40)}"`;
      const box = node.getBoundingClientRect();
      const seen = box.right > 0 && box.left < innerWidth && box.bottom > 0 && box.top < innerHeight;
      const focused = look(node);
      node.blur();
      const plain = look(node);
      node.focus({ focusVisible: true });
      return { name, shows: focused !== plain, seen };
    }, looks.toString());
    if (result.end) break;
    if (!result.shows) found.push(`focus: ${result.name}: does not show that it has the focus`);
    if (!result.seen) found.push(`focus: ${result.name}: has the focus out of sight`);
  }
  await page.evaluate(() => {
    document.activeElement?.blur();
    delete window.kerfAudited;
  });
  return found;
}

/**
 * All complaints about the page as it is now, at 1280 x 720 and 1024 x 768; the size it had is given back to it.
 * Options: sizes, focus (false: leave the focus alone), steps (how many times Tab is pressed at most).
 */
export async function audit(
  page,
  {
    sizes = [
      [1280, 720],
      [1024, 768],
    ],
    focus = true,
    steps = 120,
  } = {},
) {
  const before = page.viewportSize();
  const found = [];
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    await page.evaluate(() => new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go))));
    found.push(...(await page.evaluate(`(${complaints})()`)));
  }
  if (before) await page.setViewportSize(before);
  if (focus) found.push(...(await focusComplaints(page, steps)));
  return [...new Set(found)];
}
