#include "html/zoom.h"

namespace kerf::bench {

/// `charts` of a figure share one x axis, of which `view` is shown; each has its own y axis, as what is in
/// view needs it.
std::string_view html_zoom_script() noexcept {
  return R"js("use strict";
const left = 84, right = 14, top_ = 34, bottom = 42, tall = 240;

function nice(begin, end, most) {  // round numbers within a range
  const raw = (end - begin) / most, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find(one => one * power >= raw * 0.999) * power;
  const all = [];
  for (let i = Math.ceil(begin / step - 1e-9); i * step <= end + step * 1e-9; ++i) all.push(i * step);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return all.map(at => [at, Math.abs(at) >= 1e6 || step < 1e-5 ? Number(at.toPrecision(9)).toExponential() : at.toFixed(digits)]);
}

function before(x, at) {  // the last row at or before a place, or the first
  let low = 0, high = x.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= at) low = middle; else high = middle;
  }
  return low;
}

function extent(chart, view) {
  let low = Infinity, high = -Infinity;
  for (const curve of chart.curves) {
    const last = Math.min(curve.x.length - 1, before(curve.x, view[1]) + 1);
    for (let i = before(curve.x, view[0]); i <= last; ++i) {
      if (curve.y[i] === null) continue;
      low = Math.min(low, curve.y[i]);
      high = Math.max(high, curve.y[i]);
    }
  }
  for (const line of chart.horizontal) {
    low = Math.min(low, line.at);
    high = Math.max(high, line.at);
  }
  if (!(low <= high)) return [-1, 1];
  const margin = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low - margin, high + margin];
}

function drawCurve(g, curve, view, px, py) {
  g.strokeStyle = g.fillStyle = curve.colour;
  g.lineWidth = curve.width;
  const first = before(curve.x, view[0]), last = Math.min(curve.x.length - 1, before(curve.x, view[1]) + 1);
  const dots = last - first < 120;
  let down = false;
  g.beginPath();
  for (let i = first; i <= last; ++i) {
    if (curve.y[i] === null) { down = false; continue; }
    g[down ? "lineTo" : "moveTo"](px(curve.x[i]), py(curve.y[i]));
    down = true;
  }
  g.stroke();
  for (let i = first; dots && i <= last; ++i)
    if (curve.y[i] !== null) g.fillRect(px(curve.x[i]) - 1 - curve.width / 2, py(curve.y[i]) - 1 - curve.width / 2, 2 + curve.width, 2 + curve.width);
}

function tag(g, text, x, y) {  // readable over curves
  g.save();
  g.setLineDash([]);
  g.strokeStyle = "rgba(255, 255, 255, 0.85)";
  g.lineWidth = 4;
  g.strokeText(text, x, y);
  g.restore();
  g.fillText(text, x, y);
}

function drawChart(g, chart, view, px, width, y0) {
  const y = extent(chart, view), low = y0 + tall - bottom, high = y0 + top_;
  const py = at => low - (at - y[0]) / (y[1] - y[0]) * (low - high);
  g.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  g.save();
  g.beginPath();
  g.rect(left, high, width - left - right, low - high);
  g.clip();
  for (const band of chart.bands) {
    g.globalAlpha = 0.3;
    g.fillStyle = band.colour;
    g.fillRect(px(band.begin), high, Math.max(1, px(band.end) - px(band.begin)), low - high);
  }
  g.globalAlpha = 1;
  g.restore();
  g.strokeStyle = "#e4e4e4";
  g.lineWidth = 1;
  g.fillStyle = "#333";
  const line = (x0, y0, x1, y1) => { g.beginPath(); g.moveTo(x0, y0); g.lineTo(x1, y1); g.stroke(); };
  g.textAlign = "right";
  g.textBaseline = "middle";
  for (const [at, text] of nice(y[0], y[1], 5)) { line(left, py(at), width - right, py(at)); g.fillText(text, left - 6, py(at)); }
  g.textAlign = "center";
  g.textBaseline = "top";
  for (const [at, text] of nice(view[0], view[1], 8)) { line(px(at), high, px(at), low); g.fillText(text, px(at), low + 5); }
  g.fillText(chart.x_label, (left + width - right) / 2, low + 21);
  g.save();
  g.translate(12, (low + high) / 2);
  g.rotate(-Math.PI / 2);
  g.textBaseline = "middle";
  g.fillText(chart.y_label, 0, 0);
  g.restore();
  g.save();
  g.beginPath();
  g.rect(left, high, width - left - right, low - high);
  g.clip();
  for (const curve of chart.curves) drawCurve(g, curve, view, px, py);
  g.strokeStyle = "#555";
  g.fillStyle = "#333";
  g.lineWidth = 1;
  g.setLineDash([5, 4]);
  g.textAlign = "right";
  for (const one of chart.horizontal) {
    const below = py(one.at) < high + 15;
    line(left, py(one.at), width - right, py(one.at));
    g.textBaseline = below ? "top" : "bottom";
    tag(g, one.label, width - right - 4, py(one.at) + (below ? 2 : -1));
  }
  g.textBaseline = "top";
  for (const [i, one] of chart.vertical.entries()) {
    const after = px(one.at) < 0.25 * width || (one.label_after && px(one.at) < 0.75 * width);
    line(px(one.at), high, px(one.at), low);
    g.textAlign = after ? "left" : "right";
    tag(g, one.label, px(one.at) + (after ? 4 : -4), high + 3 + 15 * i);
  }
  g.restore();
  g.strokeStyle = "#333";
  g.strokeRect(left, high, width - left - right, low - high);
  g.textAlign = "left";
  g.textBaseline = "middle";
  g.font = "bold " + g.font;
  g.fillText(chart.title, left, y0 + 16);
  g.font = g.font.replace("bold ", "");
  let at = width - right;
  g.textAlign = "right";
  for (const curve of chart.curves.filter(one => one.label).reverse()) {
    g.fillStyle = "#333";
    g.fillText(curve.label, at, y0 + 16);
    at -= g.measureText(curve.label).width + 26;
    g.fillStyle = curve.colour;
    g.fillRect(at, y0 + 15, 20, Math.max(2, curve.width));
    at -= 12;
  }
}

function zoomable(figure) {
  const charts = JSON.parse(figure.querySelector("script").textContent);
  let x = null;
  for (const curve of charts.flatMap(one => one.curves)) x = curve.x = curve.x ?? x;
  const all = charts.flatMap(one => one.curves).filter(one => one.x.length > 0);
  if (all.length === 0) return;
  const whole = [Math.min(...all.map(one => one.x[0])), Math.max(...all.map(one => one.x[one.x.length - 1]))];
  if (!(whole[1] > whole[0])) return;
  const least = Math.max(4 * (whole[1] - whole[0]) / all[0].x.length * 1e-3, 1e-12);
  const canvas = document.createElement("canvas"), bar = document.createElement("p"), said = document.createElement("output");
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", charts.map(one => one.title).join("; "));
  let view = whole.slice(), width = 0, from = null, to = null;
  const px = at => left + (at - view[0]) / (view[1] - view[0]) * (width - left - right);
  const place = event => {
    const pixel = Math.min(width - right, Math.max(left, event.clientX - canvas.getBoundingClientRect().left));
    return view[0] + (pixel - left) / (width - left - right) * (view[1] - view[0]);
  };
  const draw = () => {
    width = figure.clientWidth - 20;
    const dense = window.devicePixelRatio || 1;
    canvas.width = width * dense;
    canvas.height = tall * charts.length * dense;
    canvas.style.width = width + "px";
    canvas.style.height = tall * charts.length + "px";
    const g = canvas.getContext("2d");
    g.scale(dense, dense);
    g.fillStyle = "#fff";
    g.fillRect(0, 0, width, tall * charts.length);
    charts.forEach((chart, i) => drawChart(g, chart, view, px, width, tall * i));
    if (from === null) return;
    g.fillStyle = "rgba(0, 114, 178, 0.15)";
    g.fillRect(px(Math.min(from, to)), 0, Math.abs(px(to) - px(from)), tall * charts.length);
  };
  const show = (begin, end) => {
    const wide = Math.min(whole[1] - whole[0], Math.max(least, end - begin));
    const first = Math.min(whole[1] - wide, Math.max(whole[0], (begin + end - wide) / 2));
    view = [first, first + wide];
    figure.dataset.view = view.join(" ");
    draw();
  };
  const scaled = (factor, about) => show(about - factor * (about - view[0]), about + factor * (view[1] - about));
  const moved = share => show(view[0] + share * (view[1] - view[0]), view[1] + share * (view[1] - view[0]));
  const middle = () => (view[0] + view[1]) / 2;
  const tell = at => {
    const row = before(all[0].x, at);
    const words = [charts[0].x_label.replace(/ \[.*/, "") + " " + all[0].x[row] + (charts[0].x_label.match(/\[(.*)\]/)?.[1] ?? "").replace(/^/, " ")];
    for (const chart of charts)
      for (const curve of chart.curves)
        if (curve.label) words.push(curve.label + " " + (curve.y[before(curve.x, at)] ?? "no number") + " " + (chart.y_label.match(/\[(.*)\]/)?.[1] ?? ""));
    said.textContent = words.join(", ");
  };
  const deeds = { "Closer": () => scaled(0.5, middle()), "Farther": () => scaled(2, middle()), "Earlier": () => moved(-0.5),
                  "Later": () => moved(0.5), "All": () => show(...whole) };
  for (const [name, deed] of Object.entries(deeds)) {
    const button = document.createElement("button");
    button.textContent = name;
    button.addEventListener("click", deed);
    bar.append(button, " ");
  }
  bar.append("or drag over a stretch; Ctrl and the wheel; arrows, + and -; a double click shows all");
  canvas.addEventListener("pointerdown", event => { if (event.button === 0) { from = to = place(event); canvas.setPointerCapture(event.pointerId); } });
  canvas.addEventListener("pointermove", event => {
    tell(place(event));
    if (from === null) return;
    to = place(event);
    draw();
  });
  canvas.addEventListener("pointerup", () => {
    const [begin, end] = [Math.min(from, to), Math.max(from, to)];
    const wide = px(end) - px(begin);
    from = null;
    if (wide > 4) show(begin, end); else draw();
  });
  canvas.addEventListener("pointercancel", () => { from = null; draw(); });
  canvas.addEventListener("dblclick", deeds.All);
  canvas.addEventListener("wheel", event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    scaled(event.deltaY < 0 ? 0.8 : 1.25, place(event));
  }, { passive: false });
  canvas.addEventListener("keydown", event => {
    const deed = { "+": "Closer", "-": "Farther", "ArrowLeft": "Earlier", "ArrowRight": "Later", "0": "All" }[event.key];
    if (deed) { event.preventDefault(); deeds[deed](); }
  });
  figure.querySelector("svg").style.display = "none";
  figure.append(bar, canvas, said);
  window.addEventListener("resize", draw);
  draw();
}

document.querySelectorAll("figure.zoom").forEach(zoomable);
)js";
}

}  // namespace kerf::bench
