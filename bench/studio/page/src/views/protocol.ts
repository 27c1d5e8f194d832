import type { ProtocolCheck, ProtocolText } from "../api/protocols";
import { keep, kept } from "../editor/kept";
import { ProtocolForm } from "../sessions/protocol_form";
import { button, element, labelled } from "../ui/dom";
import { whyNoName } from "../ui/file_names";
import { Latest } from "../ui/latest";
import type { PageContext, View } from "../ui/view";

const after_ms = 300; // of silence a changed text is tried

const keyOf = (id: string): string => `kerf-protocol-${id || "new"}`;

function inWords(check: ProtocolCheck): string {
  if (check.problem) return check.problem;
  const { samples = [], trials = 0, practice = 0, adaptive = false, device = "", question = "" } = check;
  const names = samples.map((it) => it.name).join(", ");
  const parts = [
    `It can be run: ${adaptive ? "at most " : ""}${trials} trials${practice > 0 ? `, ${practice} of them practice` : ""}, of ${names}.`,
    `The subject is asked: ${question}`,
    device ? "" : "No device is named: whoever begins a session says which.",
    check.has_motion ? "" : "Nothing says how the tool moves, so that it cannot be rehearsed.",
  ];
  return parts.filter(Boolean).join(" ");
}

/** A protocol as text that is tried while it is written; of a new one a form writes the first text. */
function mount(root: HTMLElement, context: PageContext): () => void {
  const { api, place, signal } = context;
  const latest = new Latest(signal);
  let timer = 0;
  const before = kept(keyOf(place.id)) as { name: string; text: string } | null; // ahead of what is kept below
  let isByHand = place.id !== "" || before !== null;
  let isTouched = before !== null;
  let saved = ""; // the text that stands in the file

  const head = element("h1", { tabindex: -1 }, place.id ? "A protocol" : "A new protocol");
  const name = element("input", {
    type: "text",
    maxlength: 80,
    spellcheck: "false",
    autocomplete: "off",
    input: () => changed(),
    "aria-describedby": "protocol_name_why",
  });
  const nameWhy = element("p", { id: "protocol_name_why", class: "wrong", role: "status" });
  let taken: ReadonlySet<string> = new Set(); // names of protocols of the folder
  const text = element("textarea", {
    class: "protocol_text",
    spellcheck: "false",
    rows: 30,
    input: () => {
      isByHand = true;
      changed();
    },
  });
  const verdict = element("p", { class: "verdict", role: "status" });
  const byHand = element(
    "p",
    { class: "quiet", hidden: true },
    "The text was changed by hand, and the form leaves it alone. ",
    button("Write it anew from the form", () => {
      isByHand = false;
      changed();
    }),
  );
  const save = button("Save", () => void store(), { class: "firm", disabled: true });
  const form = new ProtocolForm(() => changed());

  const changed = (): void => {
    isTouched = true;
    written();
  };

  /** Said while it is typed, not when it is refused. */
  const isNameFit = (): boolean => {
    const typed = name.value.trim();
    const why =
      typed === "" ? "" : whyNoName(typed) || (taken.has(typed) ? `${typed}.protocol.toml is there already.` : "");
    if (nameWhy.textContent !== why) nameWhy.textContent = why;
    nameWhy.hidden = why === "";
    name.setAttribute("aria-invalid", String(why !== ""));
    return why === "";
  };

  const written = (): void => {
    isNameFit();
    if (!isByHand) text.value = form.text(name.value.trim());
    byHand.hidden = !isByHand || place.id !== "";
    keep(keyOf(place.id), isTouched && text.value !== saved ? { name: name.value, text: text.value } : null);
    save.disabled = true;
    verdict.setAttribute("aria-busy", "true"); // what it says is of an earlier text
    latest.end(); // and so is an answer that is on its way
    clearTimeout(timer);
    timer = window.setTimeout(() => void check(), after_ms);
  };

  const check = async (): Promise<void> => {
    try {
      const order = place.id ? { id: place.id, text: text.value } : { text: text.value };
      const answer = await latest.ask(() => api.post<ProtocolCheck>("/api/protocol/check", order));
      if (!answer) return;
      const isNamed = place.id !== "" || name.value.trim() !== "";
      save.disabled = answer.problem !== "" || !isNamed || !isNameFit() || text.value === saved;
      verdict.removeAttribute("aria-busy");
      verdict.className = answer.problem ? "verdict wrong" : "verdict";
      verdict.textContent = inWords(answer) + (isNamed || answer.problem ? "" : " Name it to save it.");
    } catch (error) {
      if (!signal.aborted) context.complain(error);
    }
  };

  const store = async (): Promise<void> => {
    const order = place.id ? { id: place.id, text: text.value } : { name: name.value.trim(), text: text.value };
    try {
      const made = await api.post<{ id: string; name: string }>("/api/protocol", order);
      keep(keyOf(place.id), null);
      context.lookAtFolder();
      context.go("sessions");
      context.say(`${made.name} is saved: rehearse it, or make a session of it.`);
    } catch (error) {
      context.complain(error);
    }
  };

  const open = async (): Promise<void> => {
    if (place.id) {
      const file = await api.get<ProtocolText>("/api/protocol", { id: place.id }, signal);
      head.textContent = file.name;
      text.value = saved = file.text;
    }
    if (before) {
      [name.value, text.value] = [before.name, before.text];
      context.say("This is as it was left, and is not saved.");
    }
    written();
  };

  root.append(
    head,
    element(
      "div",
      { class: "protocol_columns" },
      place.id ? null : element("div", {}, labelled("Name of the file", name), nameWhy, form.root),
      element(
        "section",
        { "aria-label": "The protocol" },
        labelled("The protocol as text", text),
        byHand,
        verdict,
        element("div", { class: "row" }, save, element("a", { href: "#/sessions" }, "Back to the sessions")),
      ),
    ),
  );
  context.onFolder((workspace) => {
    const ending = ".protocol.toml";
    taken = new Set(
      workspace.files.filter((it) => it.kind === "protocol").map((it) => it.name.slice(0, -ending.length)),
    );
    form.offer(workspace.laws);
    form.device = workspace.device;
    if (!isByHand) written();
  });
  open().catch(context.complain);
  return () => clearTimeout(timer);
}

/** Reached from the sessions: what an experiment compares, how and by whom. */
export const protocol: View = { name: "protocol", title: "Protocol", mount };
