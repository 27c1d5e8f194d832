import "./sessions.css";

import type { SessionState } from "../api/sessions";
import type { Workspace, WorkspaceSession } from "../api/workspace";
import { apparatusFields } from "../sessions/apparatus";
import { notes } from "../sessions/notes";
import { whereItStands } from "../sessions/standing";
import { folderQuality, liveQuality } from "../sessions/quality_panel";
import { button, element, labelled } from "../ui/dom";
import type { Context, View } from "../ui/view";

const stages: Record<string, string> = {
  checking: "The laws are tried on the device",
  welcome: "Waiting for the subject",
  consent: "The subject reads the consent",
  instructions: "The subject reads the instructions",
  trial: "A trial is under way",
  feedback: "The subject reads how practice went",
  pause: "A break",
  finished: "The subject has finished",
};

/** How far a session is and how its trials go: nothing of what was felt or answered. */
function progressCard(context: Context): {
  root: HTMLElement;
  show: (state: SessionState) => void;
  stop: HTMLButtonElement;
} {
  const name = element("h2", {}, "No session is running");
  const stage = element("p", { role: "status" });
  const bar = element("progress", { max: 1, value: 0, "aria-label": "Trials done" });
  const count = element("p", { class: "count" });
  const link = element("a", { target: "_blank", rel: "noopener noreferrer" }, "Open the subject's page");
  const warnings = element("ul", { class: "warnings", "aria-label": "Warnings" });
  const stop = button("Stop the session", () => {});
  const quality = liveQuality();
  const written = notes(context);
  const root = element(
    "section",
    { class: "card progress", "aria-label": "Progress" },
    name,
    stage,
    bar,
    count,
    link,
    warnings,
    stop,
    quality.root,
    written.root,
  );
  return {
    root,
    stop,
    show(state) {
      name.textContent = state.name || "No session is running";
      stage.textContent = state.running ? (stages[state.stage] ?? state.stage) : state.ended && `Ended: ${state.ended}`;
      bar.max = Math.max(1, state.at_most);
      bar.value = state.answered;
      count.textContent =
        state.at_most > 0 ? `${state.answered} of ${state.adaptive ? "at most " : ""}${state.at_most} trials` : "";
      link.hidden = !state.subject_url;
      if (state.subject_url && link.getAttribute("href") !== state.subject_url) link.href = state.subject_url;
      stop.hidden = !state.running;
      if (warnings.childElementCount !== state.warnings.length)
        warnings.replaceChildren(...state.warnings.map((it) => element("li", {}, it)));
      quality.show(state);
      written.show(state);
    },
  };
}

/** Of a session that cannot be begun or gone on with: how it stands, and what is done with it. */
function standing(session: WorkspaceSession, hasKeyFile: boolean): HTMLElement {
  return element(
    "section",
    { class: "card", "aria-label": "The session that was chosen" },
    element("h2", {}, session.subject ? `Subject ${session.subject}, ${session.name}` : session.name),
    element("p", { class: session.error ? "wrong" : "" }, whereItStands(session)),
    session.finished ? element("p", { class: "count" }, `${session.answered} trials`) : null,
    session.finished && hasKeyFile ? element("a", { href: analysisOf([session]) }, "Analyse it") : null,
  );
}

function analysisOf(sessions: readonly WorkspaceSession[]): string {
  return `#/work/session-analyze?sessions=${encodeURIComponent(sessions.map((it) => it.name).join("\n"))}`;
}

/** What is needed to begin: the device, and the passphrase of whoever keeps the blinding. */
function startForm(
  session: WorkspaceSession,
  device: string,
  hasKeyFile: boolean,
  start: (order: Record<string, unknown>) => void,
): HTMLFormElement {
  const uri = element("input", {
    type: "text",
    placeholder: "the protocol's",
    spellcheck: "false",
    autocomplete: "off",
  });
  const passphrase = element("input", {
    type: "password",
    autocomplete: "off",
    required: session.key === "passphrase",
  });
  const check = element("input", { type: "checkbox", checked: true });
  const apparatus = apparatusFields(session.apparatus);
  return element(
    "form",
    {
      class: "card start",
      submit: (event: SubmitEvent) => {
        event.preventDefault();
        start({
          session: session.id,
          device: uri.value.trim(),
          passphrase: passphrase.value,
          check: check.checked,
          apparatus: apparatus.given(),
        });
        passphrase.value = "";
      },
    },
    element("h2", {}, `Subject ${session.subject}, ${session.name}`),
    labelled(`Device (empty: the protocol's; this studio's is ${device})`, uri),
    session.key === "passphrase"
      ? labelled("Passphrase of whoever keeps the blinding", passphrase)
      : element(
          "p",
          { class: hasKeyFile ? "quiet" : "wrong" },
          hasKeyFile
            ? "Sealed with a key file, which the studio has."
            : "Sealed with a key file, which the studio has not: start it with --key-file FILE.",
        ),
    apparatus.root,
    element("label", { class: "tick" }, check, element("span", {}, "Try the laws on the device first")),
    element(
      "button",
      { type: "submit", class: "firm" },
      session.answered > 0 ? "Go on with the session" : "Begin the session",
    ),
  );
}

const keyWords =
  "Sessions are sealed: make a key where no subject reads it (kerf session key KEEPER.key), and start the studio with " +
  "--key-file KEEPER.key to make and analyse them here.";

/** What is done with an experiment before its sessions and after them: forms of Work, filled in. */
function waysOf(workspace: Workspace, hasKeyFile: boolean): HTMLElement {
  const link = (verb: string, words: string, named: string, key: string): HTMLElement =>
    element(
      "a",
      { href: `#/work/${verb}?${key}=${encodeURIComponent(named)}`, "aria-label": `${words} ${named}` },
      words,
    );
  const protocols = workspace.files.filter((it) => it.kind === "protocol");
  const finished = workspace.sessions.filter((it) => it.finished);
  const fresh = element("a", { href: "#/protocol" }, "Write a protocol");
  if (protocols.length === 0)
    return element(
      "p",
      {},
      "An experiment begins with a protocol: what is compared, how and by how many. ",
      fresh,
      hasKeyFile ? null : ` ${keyWords}`,
    );
  return element(
    "ul",
    { class: "ways", "aria-label": "Experiments" },
    element("li", {}, fresh),
    ...protocols.map(({ id, name }) =>
      element(
        "li",
        {},
        element("span", { class: "name" }, name),
        element("a", { href: `#/protocol/${id}`, "aria-label": `Change ${name}` }, "Change"),
        link("session-plan", "Plan", name, "protocol"),
        link("session-simulate", "Rehearse", name, "protocol"),
        hasKeyFile ? link("session-new", "Make a session", name, "protocol") : null,
      ),
    ),
    finished.length > 0 && hasKeyFile
      ? element(
          "li",
          {},
          element("span", { class: "name" }, `${finished.length} finished`),
          element("a", { href: analysisOf(finished) }, "Analyse"),
        )
      : null,
    hasKeyFile ? null : element("li", { class: "quiet" }, keyWords),
  );
}

function isOther(one: WorkspaceSession, other: WorkspaceSession | undefined): boolean {
  return one.id !== other?.id || whereItStands(one) !== whereItStands(other);
}

function mount(root: HTMLElement, context: Context): () => void {
  const card = progressCard(context);
  const list = element("ul", { class: "files", "aria-label": "Sessions" });
  const form = element("div", { class: "form" });
  const intro = element(
    "p",
    { class: "quiet" },
    "While a session runs the scope shows nothing, and nobody can tell here which sample is felt.",
  );
  const ways = element("div", {});
  root.append(
    element("h1", { tabindex: -1 }, "Sessions"),
    element("div", { class: "columns" }, element("div", {}, intro, ways, list, form), card.root),
    folderQuality(context, () => known, { head: "How the trials of all sessions went", read: "Read all sessions" }),
  );
  let device = "";
  let hasKeyFile = false;
  let known: readonly WorkspaceSession[] = [];
  let running = ""; // the name of the session that runs

  const mayRun = (session: WorkspaceSession): boolean => running === "" && !session.finished && session.error === "";

  const begin = (order: Record<string, unknown>): void => {
    context.say("The session is being opened");
    context.api.post<SessionState>("/api/session/start", order).then((state) => {
      card.show(state);
      form.replaceChildren();
      context.say("");
      look().catch(context.complain);
    }, context.complain);
  };

  const choose = (session: WorkspaceSession): void => {
    const its = { head: `How the trials of ${session.name} went`, read: "Read its trials" };
    form.replaceChildren(
      mayRun(session) ? startForm(session, device, hasKeyFile, begin) : standing(session, hasKeyFile),
      ...(session.answered > 0 ? [folderQuality(context, () => [session], its)] : []),
    );
    form.querySelector("input")?.focus();
  };

  const refresh = async (): Promise<void> => show(await context.folder());
  const show = (workspace: Workspace): void => {
    device = workspace.device;
    known = workspace.sessions;
    ways.replaceChildren(waysOf(workspace, hasKeyFile));
    list.replaceChildren(
      ...workspace.sessions.map((it) =>
        element(
          "li",
          {},
          element("a", { class: "name", href: `#/sessions/${it.id}` }, it.name),
          element("span", {}, it.subject ? `subject ${it.subject}` : ""),
          element("span", { class: "quiet" }, whereItStands(it)),
          button(it.answered > 0 ? "Go on" : "Begin", () => choose(it), {
            disabled: !mayRun(it),
            "aria-label": `${it.answered > 0 ? "Go on with" : "Begin"} ${it.name}`,
          }),
        ),
      ),
    );
    if (workspace.sessions.length === 0)
      list.replaceChildren(element("li", {}, "There is no session in this folder yet."));
  };

  const look = async (): Promise<void> => {
    const state = await context.api.get<SessionState>("/api/session");
    card.show(state);
    hasKeyFile = state.has_key_file;
    const now = state.running ? state.name : "";
    if (running === now) return;
    running = now;
    await refresh();
  };
  card.stop.addEventListener(
    "click",
    () => void context.api.post("/api/session/stop").then(look).catch(context.complain),
  );
  // A session that another process runs goes on, too.
  context.onFolder((workspace) => workspace.sessions.some((it, k) => isOther(it, known[k])) && show(workspace));
  look()
    .then(refresh) // which offers what there is a key for
    .then(() => {
      const asked = known.find((it) => it.id === context.place.id);
      if (asked && running !== asked.name) choose(asked);
    })
    .catch(context.complain);
  const timer = setInterval(() => void look().catch(context.complain), 500);
  return () => clearInterval(timer);
}

export const sessions: View = { name: "sessions", title: "Sessions", mount };
