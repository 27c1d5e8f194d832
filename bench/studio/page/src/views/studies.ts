import "./studies.css";

import type { Study, StudyEntry } from "../api/studies";
import { element } from "../ui/dom";
import type { View } from "../ui/view";
import { studyList } from "../studies/study_list";
import { StudyPage } from "../studies/study_page";

export const studies: View = {
  name: "studies",
  title: "Studies",
  mount(root, context) {
    const gone = new AbortController();
    const title = element("h1", {}, "Studies");
    root.append(title);
    let page: StudyPage | null = null;
    const show = async (): Promise<void> => {
      const { id } = context.place;
      if (id) {
        const study = await context.api.get<Study>("/api/study", { id }, gone.signal);
        if (gone.signal.aborted) return;
        title.textContent = `Study ${study.name}`;
        page = new StudyPage(context, study);
        root.append(page.root);
        return;
      }
      const list = await context.api.get<StudyEntry[]>("/api/studies", {}, gone.signal);
      if (!gone.signal.aborted) root.append(studyList(list));
    };
    show().catch(context.complain);
    return () => {
      gone.abort();
      page?.end();
    };
  },
};
