import type { View } from "../ui/view";
import { devices } from "../views/devices";
import { editor } from "../views/editor";
import { importView } from "../views/import";
import { protocol } from "../views/protocol";
import { recording } from "../views/recording";
import { recordings } from "../views/recordings";
import { chart, fits } from "../views/results";
import { scope } from "../views/scope";
import { sessions } from "../views/sessions";
import { stability } from "../views/stability";
import { studies } from "../views/studies";
import { sweeps } from "../views/sweeps";
import { work } from "../views/work";

/** The pages of the bar, in its order. */
export const pages: readonly View[] = [
  scope,
  recordings,
  importView,
  stability,
  studies,
  sweeps,
  sessions,
  devices,
  work,
];

/** Reached by a link: a recording, a protocol, and what addresses of earlier versions name. */
export const hiddenPages: readonly View[] = [recording, protocol, editor, fits, chart];

/** The page of the bar that such a one belongs to. */
export const belongsTo: Readonly<Record<string, string>> = {
  recording: "recordings",
  protocol: "sessions",
  editor: "recordings",
  fits: "recordings",
  chart: "recordings",
};
