import type { OfferedNames, VerbForm, VerbValue } from "../api/jobs";
import { button, element } from "../ui/dom";
import type { Context } from "../ui/view";
import { namesFor, plainName, valueField, type ValueField } from "./value_field";

/** The address that a verb's form has: "session simulate" is "session-simulate". */
export function slug(form: VerbForm): string {
  return form.verb.replaceAll(" ", "-");
}

/** A verb as a form: what it needs first, all else folded away. */
export class VerbPage {
  readonly root: HTMLElement;
  private readonly fields = new Map<string, ValueField>();
  private readonly wrong = element("p", { class: "wrong", role: "alert" });
  private readonly run = element("button", { type: "submit", class: "firm" }, "Run");

  constructor(
    private readonly context: Context,
    private readonly form: VerbForm,
    names: OfferedNames,
    private readonly ordered: (job: number) => void,
    given?: { recording: string; results: readonly string[] },
  ) {
    for (const value of form.values) this.fields.set(value.name, valueField(value, names));
    const first = form.values.filter((it) => it.required || it.name === "--output" || isSubject(it));
    const rest = form.values.filter((it) => !first.includes(it));
    const [example = "", ...more] = form.more.replace(/^Example:\n/, "").split("\n\n");
    this.root = element(
      "section",
      { class: "verb_page", "aria-label": form.title },
      element("p", {}, `${form.description}.`),
      element(
        "form",
        { submit: (event: Event) => this.order(event) },
        ...first.map((it) => this.fields.get(it.name)!.root),
        rest.length > 0
          ? element(
              "details",
              {},
              element("summary", {}, `${rest.length} more options`),
              ...rest.map((it) => this.fields.get(it.name)!.root),
            )
          : null,
        this.wrong,
        element(
          "div",
          { class: "row" },
          this.run,
          button("Clear", () => this.clear()),
        ),
      ),
      element(
        "details",
        {},
        element("summary", {}, "What it does"),
        ...more.map((it) => element("p", {}, it.replaceAll("\n", " "))),
        element("p", {}, "At a terminal: ", element("code", {}, example.trim())),
      ),
    );
    this.prefill(names, given?.recording ?? this.context.state.get("recording"));
    const listed = form.values.find((it) => it.kind === "file" && it.repeated);
    const results = given?.results.filter((it) => listed && namesFor(listed, names).includes(it)) ?? [];
    if (listed && results.length > 0) this.fields.get(listed.name)?.set(results);
  }

  /**
   * Files that the address names, `?recording=cut.h5&law=fits/kelvin.law.toml`, `protocol`, a line each of `sessions`; and a name
   * for the result.
   */
  private prefill(names: OfferedNames, recording: string | null): void {
    const { state } = this.context;
    const given = [recording, state.get("law"), state.get("protocol")].filter((it) => it !== null);
    for (const name of given) {
      const value = this.form.values.find((it) => it.kind === "file" && namesFor(it, names).includes(name));
      if (value) this.fields.get(value.name)?.set(value.repeated ? [name] : name);
    }
    const sessions = state.get("sessions")?.split("\n") ?? [];
    const listed = this.form.values.find((it) => it.kind === "file" && it.repeated);
    const known = sessions.filter((it) => listed && namesFor(listed, names).includes(it));
    if (listed && known.length > 0) this.fields.get(listed.name)?.set(known);
    const output = this.form.values.find((it) => it.kind === "output" && it.name === "--output");
    if (given[0]?.endsWith(".partial")) return; // it is closed under the name that it was to have
    const stem = (given[0] ?? "").replace(/.*\//, "").replace(/(\.law\.toml|\.protocol\.toml|\.h5)$/, "");
    const verb = this.form.verb.replace(/.* /, "");
    if (output) this.fields.get(output.name)?.set(freeName(stem ? `${stem}-${verb}` : verb, output, names));
  }

  private clear(): void {
    for (const field of this.fields.values()) field.set(undefined);
    this.wrong.textContent = "";
  }

  private order(event: Event): void {
    event.preventDefault();
    this.wrong.textContent = "";
    const values: Record<string, unknown> = {};
    for (const [name, field] of this.fields) {
      const value = field.value();
      if (value !== undefined) values[name] = value;
    }
    this.run.disabled = true;
    this.context.api
      .post<{ job: number }>("/api/verbs/run", { verb: this.form.verb, values })
      .then(({ job }) => this.ordered(job))
      .catch((error: unknown) => this.complain(error))
      .finally(() => (this.run.disabled = false));
  }

  /** At the field that it is about, where it names one. */
  private complain(error: unknown): void {
    const text = error instanceof Error ? error.message : String(error);
    const name = [...this.fields.keys()].find((it) => text.startsWith(`${it}: `));
    this.wrong.textContent = name ? `${plainName(name)}: ${text.slice(name.length + 2)}` : text;
    const control = name ? this.fields.get(name)?.root.querySelector<HTMLElement>("input, select") : null;
    for (const field of this.fields.values()) field.root.classList.remove("has_wrong");
    control?.closest(".value_field")?.classList.add("has_wrong");
    control?.closest("details")?.setAttribute("open", "");
    control?.focus();
  }
}

/** What the verb is about, though it may be left out. */
function isSubject(value: VerbValue): boolean {
  return !value.name.startsWith("-") || ["--through", "--device", "--subject", "--subjects"].includes(value.name);
}

/** The name, or with a number behind it where it is taken. */
function freeName(name: string, output: VerbValue, names: OfferedNames): string {
  const clean = name.replace(/[^A-Za-z0-9_.-]+/g, "-").replace(/^[^A-Za-z0-9]+/, "") || "result";
  const taken = new Set([...names.files, ...names.folders]);
  const isTaken = (it: string): boolean => output.words.some((ending) => taken.has(`${it}${ending}`));
  let free = clean;
  for (let k = 2; isTaken(free) && k < 1000; ++k) free = `${clean}-${k}`;
  return free;
}
