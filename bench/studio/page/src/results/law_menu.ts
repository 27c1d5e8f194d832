import type { LawView } from "../api/results";
import { element, labelled, select, setOptions } from "../ui/dom";
import { download, fileName } from "../ui/plot/out/download";
import { menu } from "../ui/plot/out/export_menu";
import type { Context } from "../ui/view";

interface Host {
  name: string;
  what: string;
}

/** Endings of what is a single file. */
const alone: Readonly<Record<string, string>> = { c: "c", python: "py", fmu: "fmu" };

/** Hands a law out: its file, or what `kerf export` makes of it for another program. */
export function lawMenu({ api, complain }: Context, law: { id: string; name: string }, title: string): HTMLElement {
  const host = select([], "", () => {});
  const stem = law.name.replace(/^.*\//, "").replace(/\.law\.toml$/, "");
  const file = async (): Promise<void> => {
    const { toml } = await api.get<LawView>("/api/law", { id: law.id });
    download(toml, fileName(stem, "law.toml"));
  };
  const exported = async (): Promise<void> => {
    const { content, type } = await api.file("/api/law/exported", { id: law.id, host: host.value });
    const ending = type === "application/zip" ? "zip" : (alone[host.value] ?? "txt");
    download(content, fileName(`${stem} ${host.value}`, ending));
  };
  const root = menu(
    "Save law",
    { "Law file": file, "For the program": exported },
    labelled("Program", host),
    element("p", { class: "quiet" }, "What kerf export writes: one file, or a zip of several."),
  );
  root.querySelector("summary")?.setAttribute("aria-label", `Save law: ${title}`);
  root.addEventListener("toggle", () => {
    if (host.options.length > 0) return;
    api.get<Host[]>("/api/laws/hosts").then(
      (all) =>
        setOptions(
          host,
          all.map((it) => ({ value: it.name, text: `${it.name}: ${it.what}` })),
        ),
      complain,
    );
  });
  return root;
}
