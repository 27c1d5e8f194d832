import "./studio.css";

import { Api } from "./api/api";
import { byId, Notice } from "./shell/notice";
import { Shell } from "./shell/shell";
import { keepTextsWhole } from "./ui/words/whole_texts";
import { ForceBar } from "./ui/force/force_bar";

const api = new Api(document.querySelector<HTMLMetaElement>("meta[name=kerf-token]")?.content ?? "");
const notice = new Notice();
new ForceBar(api, byId("force_bar"), (error) => notice.complain(error)); // first: whatever fails below, Escape is heard
new Shell(api, notice);
keepTextsWhole();
