import "./work.css";

import type { OfferedNames, VerbForm } from "../api/jobs";
import { FilePage } from "../jobs/file_page";
import { JobList } from "../jobs/job_list";
import { JobPage } from "../jobs/job_page";
import { JobWatch } from "../jobs/job_watch";
import { slug, VerbPage } from "../jobs/verb_page";
import { element } from "../ui/dom";
import type { PageContext, View } from "../ui/view";

const files = "files"; // in the address

/** What can be asked for, by what one wants to do. */
function verbList(forms: readonly VerbForm[], current: string): HTMLElement {
  const groups = [...new Set(forms.map((it) => it.group))];
  const line = (name: string, title: string, hint: string): HTMLElement => {
    const here = name === current ? { "aria-current": "page" } : {};
    return element("li", {}, element("a", { href: `#/work/${name}`, title: hint, ...here }, title));
  };
  const link = (form: VerbForm): HTMLElement => line(slug(form), form.title, `kerf ${form.verb}`);
  return element(
    "nav",
    { class: "verb_list", "aria-label": "What can be done" },
    element(
      "div",
      {},
      element("p", { class: "group" }, "files"),
      element("ul", {}, line(files, "Rename, note, delete", "Files")),
    ),
    ...groups.map((group) =>
      element(
        "div",
        {},
        element("p", { class: "group" }, group),
        element("ul", {}, ...forms.filter((it) => it.group === group).map(link)),
      ),
    ),
  );
}

/** The page of jobs: what can be asked for at the left, what was at the right, one of them between. */
export const work: View = {
  name: "work",
  title: "Work",
  mount(root, context: PageContext) {
    const { api, signal, place } = context;
    const list = new JobList();
    const number = /^\d+$/.test(place.id) ? Number(place.id) : -1;
    const head = element("h1", {}, "Work");
    const middle = element("div", { class: "work_middle" }, head);
    const left = element("div", {});
    root.append(element("div", { class: "work_page" }, left, middle, list.root));
    const job = number >= 0 ? new JobPage(context, number, () => void watch.look()) : null;
    if (job) middle.append(job.root);
    const watch = new JobWatch(api, signal, (jobs) => {
      list.show(jobs, number);
      job?.show(jobs);
    });
    const show = async (): Promise<void> => {
      const forms = await api.get<VerbForm[]>("/api/verbs", {}, signal);
      left.replaceWith(verbList(forms, place.id));
      const form = forms.find((it) => slug(it) === place.id);
      if (job) {
        head.textContent = `Job ${number}`;
      } else if (place.id === files) {
        head.textContent = "Files";
        middle.append(new FilePage(context).root);
      } else if (form) {
        head.textContent = form.title;
        const names = await api.get<OfferedNames>("/api/verbs/files", {}, signal);
        middle.append(new VerbPage(context, form, names, (ordered) => context.go("work", String(ordered))).root);
      } else {
        if (place.id) context.say("There is no such work.");
        middle.append(
          element(
            "p",
            { class: "quiet" },
            "Pick at the left what is to be done. It runs beside the loop and never in its way, and goes on when this page is closed.",
          ),
        );
      }
    };
    show().catch(context.complain);
    return () => {};
  },
};
