// The page of a subject: shows the view that the server has, sends what the subject does. Everything that it shows comes
// as text; words that depend on the view are made by the server, the same ones as on the terminal.
"use strict";

const token = new URLSearchParams(location.search).get("token") || "";
const element = (id) => document.getElementById(id);

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

function labelled(verb, label) {
  const shown = document.createElement("span");
  shown.className = "label";
  shown.textContent = label;
  return verb ? [verb + " ", shown] : [shown];
}

function tile(label) {
  const made = document.createElement("div");
  made.className = "tile";
  made.setAttribute("aria-hidden", "true");
  made.append(...labelled("", label));
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

function buildRows() {
  const trial = view.stage === "trial";
  element("feel").hidden = !trial;
  element("answer").hidden = !trial;
  element("go_on").hidden = trial || view.stage === "finished";
  element("feel_row").replaceChildren(
    ...view.labels.map((label, slot) => (free ? button(labelled("Feel", label), { kind: "play", slot }) : tile(label))),
  );
  element("answer_row").replaceChildren(
    ...view.labels
      .slice(0, view.answers)
      .map((label, slot) => button(labelled("Answer", label), { kind: "answer", slot }, "firm")),
  );
  element("go_on").replaceChildren(
    ...(view.stage === "consent"
      ? [button(["I do not agree"], { kind: "decline" }, "quiet"), button(["I agree"], { kind: "go_on" }, "firm")]
      : [button(["Continue"], { kind: "go_on" }, "firm")]),
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
  for (const made of element("answer_row").children) enable(made, view.may_answer);
  for (const made of element("go_on").children) enable(made, view.may_go_on);
  element("answer_row").classList.toggle("armed", armed);
}

function choices(count) {
  const labels = view.labels.slice(0, count);
  return labels.length < 2 ? labels.join("") : labels.slice(0, -1).join(", ") + " or " + labels.at(-1);
}

function keysText() {
  if (view.stage === "trial" && free) {
    return armed
      ? `Answer: which? ${choices(view.answers)}. Escape: not yet.`
      : `Keys: ${choices(view.labels.length)} to feel, Enter to answer.`;
  }
  if (view.stage === "trial") return view.may_answer ? `Keys: ${choices(view.answers)} to answer.` : "";
  return view.may_go_on && view.stage !== "consent" ? "Keys: Space or Enter to continue." : "";
}

function tellWait() {
  if (!view) return;
  const left = Math.ceil((readyAt - performance.now()) / 1000);
  const waits = view.stage === "pause" && !view.may_go_on && left > 0;
  setText("notice", view.notice || (waits ? `You can go on in ${left} s.` : ""));
}

function announcement(before, fresh) {
  const now = (key) => view[key] && (fresh || before[key] !== view[key]);
  return [
    fresh ? view.progress || view.heading : "",
    now("plays") ? view.plays : "",
    now("may_answer") ? `You can answer now: ${choices(view.answers)}.` : "",
    now("may_go_on") && view.stage === "pause" ? "You can go on." : "",
    now("notice") ? view.notice : "",
  ]
    .filter(Boolean)
    .map((part) => (/[.!?]$/.test(part) ? part : part + "."))
    .join(" ");
}

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
  if (fresh || free !== wasFree || String(before.labels) !== String(view.labels) || before.answers !== view.answers) {
    buildRows();
  }
  element("stop").hidden = view.stage === "finished";
  markRows();
  setText("keys", keysText());
  tellWait();
  if (fresh) {
    element("stop_dialog").close();
    window.scrollTo(0, 0);
    element("heading").focus({ preventScroll: true });
  }
  say(announcement(before, fresh));
}

// ---- What is done

async function act(kind, slot) {
  if (!view || !connected) return;
  const screen = `${view.stage} ${view.trial}`;
  if (sending === screen) return; // a double click is one answer
  if (kind !== "play") sending = screen;
  try {
    const response = await fetch("action", {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Kerf-Token": token },
      body: JSON.stringify({ kind, slot, stage: view.stage, trial: view.trial }),
    });
    if (response.status === 409) say((await response.json()).error);
    else if (!response.ok) say("That did not work. Please try again.");
  } catch {
    say("That did not arrive. Please try again."); // follow() finds out whether the connection is lost
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

function slotOf(key) {
  const label = view.labels.findIndex((it) => it.toLowerCase() === key.toLowerCase());
  if (label >= 0) return label;
  return /^[1-9]$/.test(key) && Number(key) <= view.labels.length ? Number(key) - 1 : -1;
}

function keyInTrial(event) {
  const slot = slotOf(event.key);
  if (event.key === "Escape" && armed) {
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
  if (view.stage === "trial") {
    keyInTrial(event);
  } else if (
    (event.key === "Enter" || event.key === " ") &&
    view.may_go_on &&
    view.stage !== "consent" &&
    !event.target.closest("button")
  ) {
    event.preventDefault();
    act("go_on", 0);
  }
});

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
        disconnect("This page belongs to another session. Open the new address.");
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
      disconnect("Connection lost. Trying again.");
      await pause(1000);
    }
  }
}

setInterval(tellWait, 250);
follow();
