// The page of a subject: shows the view that the server has, sends what the subject does. Everything that it shows comes
// as text; words that depend on the view are made by the server, the same ones as on the terminal, and its own
// come with the page in the subject's language.
"use strict";

const token = new URLSearchParams(location.search).get("token") || "";
const element = (id) => document.getElementById(id);
const texts = JSON.parse(element("texts").textContent);

function filled(text, values) {
  return text.replace(/\{([a-z_]+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}

let view = null;
let free = false; // the subject has been able to switch in this trial
let armed = false; // Enter was pressed: the next label is the answer
let sending = ""; // the screen whose one answer, or leave, is on its way
let connected = true;
let readyAt = 0; // when a break may be left, on the clock of performance.now()

function isNewScreen(before, now) {
  return !before || before.stage !== now.stage || before.trial !== now.trial;
}

// ---- What is seen

function setText(id, text) {
  if (element(id).textContent !== text) element(id).textContent = text;
}

function say(text) {
  if (!text) return;
  const live = element("live");
  // The same words once more are only read out if something of them changes.
  live.textContent = live.textContent === text ? text + "\u00a0" : text;
}

function button(words, action, kind) {
  const made = document.createElement("button");
  made.type = "button";
  if (kind) made.className = kind;
  made.append(...words);
  made.addEventListener("click", () => {
    if (made.getAttribute("aria-disabled") !== "true") act(action.kind, action.slot || 0);
  });
  return made;
}

// The label large, wherever the language puts it.
function labelled(text, label) {
  const shown = document.createElement("span");
  shown.className = "label";
  shown.textContent = label;
  const [before, after] = text.split("{label}");
  return [before, shown, after].filter(Boolean);
}

function tile(label) {
  const made = document.createElement("div");
  made.className = "tile";
  made.setAttribute("aria-hidden", "true");
  made.append(...labelled("{label}", label));
  return made;
}

function paragraphs(text) {
  return text
    .split(/\n\s*\n/)
    .filter((part) => part.trim())
    .map((part) => {
      const made = document.createElement("p");
      made.textContent = part.trim();
      return made;
    });
}

function answerWords(label, slot) {
  const number = String(slot + 1);
  if (!hasWords()) return labelled(texts.page_answer, label);
  return label === number ? [number] : labelled(`${number} {label}`, label);
}

// ---- A number for an answer

let isGiven = false; // a number is written, or the mark on the line was set

function numberForm(asked) {
  const line = asked.ends.length === 2;
  const input = document.createElement("input");
  input.id = "number";
  input.type = line ? "range" : "text";
  isGiven = false;
  if (line) {
    input.min = String(asked.lower);
    input.max = String(asked.upper);
    input.step = String(asked.step || 1);
    input.setAttribute("aria-label", filled(texts.page_line, { low: asked.ends[0], high: asked.ends[1] }));
  } else {
    input.inputMode = "decimal";
    input.autocomplete = "off";
    input.maxLength = 12;
    input.setAttribute("aria-label", texts.page_number);
  }
  // Of a trial the heading asks, of a questionnaire the text below it: a screen reader that is led here at once says it.
  input.setAttribute("aria-describedby", view.stage === "trial" ? "heading" : "text");
  const noteNumber = () => {
    isGiven = line || Number.isFinite(writtenNumber());
    markRows();
  };
  input.addEventListener("input", noteNumber);
  if (line) input.addEventListener("click", noteNumber); // also where the mark stands already
  const give = document.createElement("button");
  give.type = "button";
  give.className = "firm";
  give.textContent = texts.page_give;
  give.addEventListener("click", answerNumber);
  const word = (text) => {
    const shown = document.createElement("span");
    shown.className = "end";
    shown.textContent = text;
    return shown;
  };
  return line ? [word(asked.ends[0]), input, word(asked.ends[1]), give] : [input, give];
}

function writtenNumber() {
  const text = element("number").value.trim().replace(",", ".");
  return text ? Number(text) : NaN;
}

function answerNumber() {
  const number = writtenNumber();
  if (!isGiven || !view.may_answer) return;
  if (number < view.asked_number.lower || number > view.asked_number.upper) {
    say(texts.page_number_cannot_be);
    return;
  }
  act("answer", 0, number);
}

function buildRows() {
  const trial = view.stage === "trial";
  element("feel").hidden = !trial;
  element("answer").hidden = !trial && !view.asked_number;
  element("feel_row").replaceChildren(
    ...view.labels.map((label, slot) =>
      free ? button(labelled(texts.page_feel, label), { kind: "play", slot }) : tile(label),
    ),
  );
  element("answer_row").replaceChildren(
    ...(view.asked_number
      ? numberForm(view.asked_number)
      : answerLabels().map((label, slot) => button(answerWords(label, slot), { kind: "answer", slot }, "firm"))),
  );
  element("answer_row").classList.toggle("words", hasWords());
  element("answer_row").classList.toggle("steps", view.in_steps);
  element("answer_row").classList.toggle("number", Boolean(view.asked_number));
  const answers = answerLabels().length;
  element("answer_row").style.setProperty("--columns", String(answers > 3 && !view.in_steps ? answers / 2 : answers));
  element("go_on").replaceChildren(
    ...(view.stage === "consent"
      ? [
          button([texts.page_disagree], { kind: "decline" }, "quiet"),
          button([texts.page_agree], { kind: "go_on" }, "firm"),
        ]
      : [button([texts.page_continue], { kind: "go_on" }, "firm")]),
  );
}

function enable(made, on) {
  made.setAttribute("aria-disabled", String(!(on && connected)));
}

function markRows() {
  [...element("feel_row").children].forEach((made, slot) => {
    const plays = view.playing === slot;
    if (free) {
      made.setAttribute("aria-pressed", String(plays));
      enable(made, view.may_switch);
    } else {
      made.classList.toggle("plays", plays);
    }
  });
  for (const made of element("answer_row").children) {
    if (made.id === "number") made.disabled = !(view.may_answer && connected);
    else if (made.tagName === "BUTTON") enable(made, view.may_answer && (!view.asked_number || isGiven));
  }
  for (const made of element("go_on").children) enable(made, view.may_go_on);
  enable(element("slip"), view.may_slip);
  element("answer_row").classList.toggle("armed", armed);
}

function hasWords() {
  return view.answer_labels.length > 0;
}

function answerLabels() {
  return hasWords() ? view.answer_labels : view.labels.slice(0, view.answers);
}

function keysText() {
  const slip = view.may_slip ? filled(texts.keys_slip, { key: "S" }) : "";
  if (view.stage === "trial" && free && armed) return filled(texts.keys_which, { answers: view.answer_list });
  if (view.stage === "trial") {
    const keys = free
      ? filled(texts.page_keys_feel, { labels: view.label_list })
      : view.may_answer &&
        (view.asked_number ? numberKeys() : filled(texts.page_keys_answer, { answers: view.answer_list }));
    return [keys, slip].filter(Boolean).join(" ");
  }
  if (view.asked_number) return view.may_answer ? numberKeys() : "";
  if (view.stage === "welcome" && noiseIsUnset()) return "";
  return view.may_go_on && view.stage !== "consent" ? texts.page_keys_go_on : "";
}

function numberKeys() {
  return view.asked_number.ends.length === 2 ? texts.page_keys_line : texts.page_keys_number;
}

function tellWait() {
  if (!view) return;
  const left = Math.ceil((readyAt - performance.now()) / 1000);
  const waits = view.stage === "pause" && !view.may_go_on && left > 0;
  setText("notice", view.notice || (waits ? filled(texts.pause_wait, { seconds: left }) : ""));
}

function announcement(before, fresh) {
  const now = (key) => view[key] && (fresh || before[key] !== view[key]);
  return [
    fresh ? view.progress || view.heading : "",
    now("plays") ? view.plays : "",
    now("may_answer") ? filled(texts.may_answer, { answers: view.answer_list }) : "",
    now("may_go_on") && (view.stage === "pause" || view.stage === "ready") ? texts.may_go_on : "",
    now("notice") ? view.notice : "",
  ]
    .filter(Boolean)
    .map((part) => (/[.!?]$/.test(part) ? part : part + "."))
    .join(" ");
}

// ---- Noise

let player = null; // made at the first click or key, before which no browser lets it sound
let hearing = false; // while its loudness is set

const noiseIsUnset = () => Boolean(view && view.noise && view.noise.level_db === null);

function followNoise() {
  const noise = view && view.noise;
  element("noise").hidden = !noise || !noiseIsUnset() || view.stage !== "welcome";
  if (element("noise").hidden) hearing = false;
  else element("go_on").hidden = true;
  element("noise_play").setAttribute("aria-pressed", String(hearing));
  if (!player || !noise) return;
  if (hearing) player.play(Number(element("noise_level").value));
  else if (view.stage === "trial" && noise.level_db !== null) player.play(noise.level_db);
  else player.stop();
}

const guide = new globalThis.GuidePanel(element("guide"), async () => {
  const response = await fetch("guide", {
    headers: { "X-Kerf-Token": token },
    cache: "no-store",
    signal: AbortSignal.timeout(2000),
  }).catch(() => null);
  return response && response.ok ? response.json() : null;
});
for (const kind of ["click", "keydown"]) document.addEventListener(kind, () => guide.wake(), true);

function wakeNoise() {
  if (!view || !view.noise) return;
  player = player || new globalThis.NoisePlayer(view.noise.kind);
  player.wake();
  followNoise();
}
for (const kind of ["click", "keydown"]) document.addEventListener(kind, wakeNoise, true);

element("noise_play").addEventListener("click", () => {
  hearing = !hearing;
  enable(element("noise_keep"), true);
  followNoise();
});
element("noise_level").addEventListener("input", followNoise);
element("noise_keep").addEventListener("click", async () => {
  if (element("noise_keep").getAttribute("aria-disabled") === "true") return;
  const response = await fetch("noise", {
    method: "POST",
    headers: { "Content-Type": "application/json", "X-Kerf-Token": token },
    body: JSON.stringify({ level_db: Number(element("noise_level").value) }),
  }).catch(() => null);
  if (!response || !response.ok) say(texts.page_failed);
});

function show(next) {
  const before = view;
  const fresh = isNewScreen(before, next);
  view = next;
  const wasFree = free;
  free = view.stage === "trial" && (view.may_switch || (free && !fresh));
  if (fresh || !view.may_answer) armed = false;
  readyAt = performance.now() + view.wait_s * 1000;

  document.title = [view.progress || view.heading, view.study].filter(Boolean).join(" – ");
  setText("study", view.study);
  setText("progress", view.progress);
  setText("heading", view.heading);
  setText("plays", view.plays);
  if (fresh || before.text !== view.text) element("text").replaceChildren(...paragraphs(view.text));
  if (
    fresh ||
    free !== wasFree ||
    String(before.labels) !== String(view.labels) ||
    String(before.answer_labels) !== String(view.answer_labels) ||
    JSON.stringify(before.asked_number) !== JSON.stringify(view.asked_number) ||
    before.answers !== view.answers
  ) {
    buildRows();
  }
  element("stop").hidden = view.stage === "finished";
  element("slip").hidden = !view.may_slip;
  const waits = view.stage === "ready" && !view.may_go_on; // for the tool, or for its time
  element("go_on").hidden = view.stage === "trial" || Boolean(view.asked_number) || view.stage === "finished" || waits;
  followNoise();
  guide.follow(view.guide, view.stage);
  markRows();
  setText("keys", keysText());
  tellWait();
  if (fresh) {
    element("stop_dialog").close();
    window.scrollTo(0, 0);
  }
  // An item of a questionnaire can be answered as soon as it is shown.
  if (view.asked_number && view.may_answer && (fresh || !before.may_answer))
    element("number").focus({ preventScroll: fresh });
  else if (fresh) element("heading").focus({ preventScroll: true });
  say(announcement(before, fresh));
}

// ---- What is done

async function act(kind, slot, number) {
  if (!view || !connected) return;
  const screen = `${view.stage} ${view.trial}`;
  if (sending === screen) return; // a double click is one answer
  if (kind !== "play") sending = screen;
  try {
    const response = await fetch("action", {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Kerf-Token": token },
      body: JSON.stringify({ kind, slot, number, stage: view.stage, trial: view.trial }),
    });
    if (response.status === 409) say((await response.json()).error);
    else if (!response.ok) say(texts.page_failed);
  } catch {
    say(texts.page_not_arrived); // follow() finds out whether the connection is lost
  } finally {
    if (sending === screen && kind !== "play") sending = "";
  }
}

function arm(on) {
  armed = on;
  markRows();
  setText("keys", keysText());
  if (on) say(keysText());
}

function placeOf(labels, key) {
  const label = labels.findIndex((it) => it.toLowerCase() === key.toLowerCase());
  if (label >= 0) return label;
  return /^[1-9]$/.test(key) && Number(key) <= labels.length ? Number(key) - 1 : -1;
}

function keyOfNumber(event) {
  const slips = event.key.toLowerCase() === "s" && view.may_slip;
  if (slips) act("slip", 0);
  else if (event.key === "Enter" && !event.target.closest("button")) answerNumber();
  else return;
  event.preventDefault();
}

function keyInTrial(event) {
  if (view.asked_number) {
    keyOfNumber(event);
    return;
  }
  const slot = placeOf(free && !armed ? view.labels : answerLabels(), event.key);
  if (event.key.toLowerCase() === "s" && view.may_slip) {
    act("slip", 0);
  } else if (event.key === "Escape" && armed) {
    arm(false);
  } else if (event.key === "Enter" && free && view.may_answer && !event.target.closest("button")) {
    arm(true);
  } else if (slot >= 0 && free && !armed) {
    if (view.may_switch) act("play", slot);
  } else if (slot >= 0 && slot < view.answers && view.may_answer) {
    armed = false;
    act("answer", slot);
  } else {
    return;
  }
  event.preventDefault();
}

document.addEventListener("keydown", (event) => {
  if (!view || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
  if (element("stop_dialog").open) return;
  if (view.stage === "trial" || view.asked_number) {
    keyInTrial(event);
  } else if (
    (event.key === "Enter" || event.key === " ") &&
    view.may_go_on &&
    view.stage !== "consent" &&
    !(view.stage === "welcome" && noiseIsUnset()) &&
    !event.target.closest("button")
  ) {
    event.preventDefault();
    act("go_on", 0);
  }
});

element("slip").addEventListener("click", () => act("slip", 0));
element("stop").addEventListener("click", () => element("stop_dialog").showModal());
element("stop_no").addEventListener("click", () => element("stop_dialog").close());
element("stop_yes").addEventListener("click", () => {
  element("stop_dialog").close();
  act("quit", 0);
});

// ---- Connection

function disconnect(why) {
  connected = false;
  setText("connection", why);
  if (view) markRows();
}

function reconnect() {
  if (connected) return;
  connected = true;
  setText("connection", "");
  if (view) markRows();
}

const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

async function follow() {
  let number = 0;
  while (!view || view.stage !== "finished") {
    try {
      const response = await fetch(`view?after=${number}`, {
        headers: { "X-Kerf-Token": token },
        cache: "no-store",
        signal: AbortSignal.timeout(30000),
      });
      if (response.status === 403) {
        disconnect(texts.page_of_another_session);
        return;
      }
      if (response.status === 200) {
        const next = await response.json();
        reconnect();
        show(next);
        number = next.number;
      } else if (response.status === 204) {
        reconnect();
      } else {
        throw new Error(`status ${response.status}`);
      }
    } catch {
      disconnect(texts.page_connection_lost);
      await pause(1000);
    }
  }
}

setInterval(tellWait, 250);
follow();
