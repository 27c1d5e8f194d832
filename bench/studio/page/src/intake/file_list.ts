import { bytes } from "../recordings/recording_list";
import { button, element } from "../ui/dom";
import type { FileState, TakenFile } from "./taken_file";

const words: Record<FileState, string> = {
  sending: "is coming",
  stopped: "has not come whole",
  ready: "ready",
  refused: "cannot be read",
  importing: "is being imported",
  done: "imported",
  failed: "not imported",
};

interface Hands {
  choose: (file: TakenFile) => void;
  remove: (file: TakenFile) => void;
  rename: (file: TakenFile, name: string) => void;
}

/** A line of the list; rebuilt by nobody, so that the focus stays. */
class FileLine {
  readonly root: HTMLLIElement;
  private readonly press: HTMLButtonElement;
  private readonly bar: HTMLProgressElement;
  private readonly words = element("span", { class: "file_state" });
  private readonly said = element("p", { class: "file_said" });
  private readonly name: HTMLInputElement;
  private readonly naming: HTMLLabelElement;
  private readonly link = element("a", { class: "go", hidden: true }, "Open");

  constructor(
    private readonly file: TakenFile,
    hands: Hands,
  ) {
    this.press = button(file.name, () => hands.choose(file), { class: "plain file_name", title: file.name });
    this.bar = element("progress", { max: 1, "aria-label": `How much of ${file.name} has come` });
    this.name = element("input", {
      maxlength: 80,
      spellcheck: "false",
      "aria-label": `Name of the recording of ${file.name}`,
      input: () => hands.rename(file, this.name.value.trim()),
    });
    this.naming = element("label", { class: "file_naming" }, this.name, element("span", {}, ".h5"));
    const remove = button("✕", () => hands.remove(file), {
      class: "small",
      "aria-label": `Take ${file.name} off the list`,
      title: "Take it off the list",
    });
    this.root = element(
      "li",
      {},
      this.press,
      element("span", { class: "quiet file_size" }, bytes(file.bytes)),
      this.words,
      this.bar,
      this.naming,
      this.link,
      remove,
      this.said,
    );
  }

  show(chosen: boolean): void {
    const { file } = this;
    this.root.className = `file_${file.state}${chosen ? " chosen" : ""}`;
    if (chosen) this.press.setAttribute("aria-current", "true");
    else this.press.removeAttribute("aria-current");
    this.bar.hidden = file.state !== "sending" && file.state !== "stopped";
    this.bar.value = file.bytes > 0 ? file.have / file.bytes : 0;
    const isUnfit = file.state === "ready" && file.problem !== "";
    this.root.classList.toggle("file_unfit", isUnfit);
    this.words.textContent =
      file.state === "sending"
        ? `${Math.floor((100 * file.have) / Math.max(1, file.bytes))} %`
        : isUnfit
          ? "not ready"
          : words[file.state];
    this.said.textContent = file.said;
    this.said.hidden = file.said === "";
    if (document.activeElement !== this.name) this.name.value = file.recording;
    this.naming.hidden = file.state === "done" || file.state === "refused";
    this.name.disabled = file.state === "importing";
    this.link.hidden = file.result === null || file.result.gone === true;
    if (file.result) {
      this.link.href = `#/recording/${file.result.recording}/time`;
      this.link.setAttribute("aria-label", `Open ${file.result.name}`);
    }
  }
}

/** The files that are taken in, each with how far it is and what its recording will be called. */
export class FileList {
  readonly root = element("ul", { class: "file_list", "aria-label": "Files" });
  private readonly lines = new Map<TakenFile, FileLine>();

  constructor(private readonly hands: Hands) {}

  show(files: readonly TakenFile[], chosen: TakenFile | null): void {
    for (const [file, line] of this.lines) {
      if (files.includes(file)) continue;
      line.root.remove();
      this.lines.delete(file);
    }
    for (const file of files) {
      let line = this.lines.get(file);
      if (!line) {
        line = new FileLine(file, this.hands);
        this.lines.set(file, line);
        this.root.append(line.root);
      }
      line.show(file === chosen);
    }
    this.root.hidden = files.length === 0;
  }
}
