import "../../views/work.css";

import type { OfferedNames, VerbForm } from "../../api/jobs";
import { VerbPage } from "../../jobs/verb_page";
import { element } from "../../ui/dom";
import type { Context, RecordingTab } from "../../ui/view";
import { factsOf } from "../facts";

/** The form of `kerf report`, with all that was found of the recording ticked. */
async function reportForm(context: Context, name: string): Promise<HTMLElement | null> {
  const [forms, names] = await Promise.all([
    context.api.get<VerbForm[]>("/api/verbs", {}, context.signal),
    context.api.get<OfferedNames>("/api/verbs/files", {}, context.signal),
  ]);
  const form = forms.find((it) => it.verb === "report");
  if (!form) return null;
  const stem = name.replace(/\.h5$/, ".");
  const results = names.files.filter((it) => it.startsWith(stem) && it.endsWith(".json"));
  return new VerbPage(context, form, names, (job) => context.go("work", String(job)), { recording: name, results })
    .root;
}

/** Writes one page of all that was found of the recording, and says what is known of it. */
export const reportTab: RecordingTab = {
  name: "report",
  title: "Report",
  mount(root, context, recording) {
    const form = element("div", {});
    root.append(
      element(
        "div",
        { class: "scrolling" },
        element("h2", {}, "Write a report"),
        form,
        element("h2", {}, "About the recording"),
        factsOf(
          recording.about,
          recording.workspace.recordings.find((it) => it.id === recording.id),
        ),
      ),
    );
    reportForm(context, recording.name).then(
      (made) => context.signal.aborted || (made && form.replaceChildren(made)),
      (error: unknown) => context.signal.aborted || context.complain(error),
    );
    return () => {};
  },
};
