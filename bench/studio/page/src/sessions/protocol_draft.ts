/** What a trial asks, and what the form has to ask for it. */
export interface DesignKind {
  readonly name: string; // in the file
  readonly words: string;
  readonly laws: "one" | "two" | "some"; // some: two and more, every pair of them
  readonly hasSignal?: boolean; // one of the laws is what is looked for
  readonly levels?: string; // of comparisons, as one types them
  readonly isJudged?: boolean; // an answer is right or wrong
  readonly trials: number;
  readonly more?: string; // lines of its own
  readonly asks?: string; // a question as somebody may put it; none: the design has its own
}

export const designs: readonly DesignKind[] = [
  { name: "abx", words: "ABX: X is A or B. Which one?", laws: "some", isJudged: true, trials: 40 },
  {
    name: "2ifc",
    asks: "Which one was stiffer?",
    words: "Two in a row, one is the signal: which one?",
    laws: "two",
    hasSignal: true,
    isJudged: true,
    trials: 30,
  },
  {
    name: "3ifc",
    words: "Three in a row: which is the odd one out?",
    laws: "two",
    isJudged: true,
    trials: 36,
    more: "odd_one_out = true",
  },
  { name: "same-different", words: "Two in a row: same or different?", laws: "some", isJudged: true, trials: 48 },
  {
    name: "yes-no",
    asks: "Did you feel the tear?",
    words: "One: was the signal there?",
    laws: "two",
    hasSignal: true,
    isJudged: true,
    trials: 60,
  },
  {
    name: "preference",
    asks: "Which one feels more like skin?",
    words: "Two: which is more like …?",
    laws: "some",
    trials: 10,
  },
  {
    name: "constant",
    asks: "Which one was stronger?",
    words: "JND by constant levels: which is stronger?",
    laws: "one",
    levels: "-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3",
    trials: 20,
  },
  {
    name: "staircase",
    asks: "Which one was stronger?",
    words: "JND by a staircase, 1 up and 2 down",
    laws: "one",
    isJudged: true,
    trials: 80,
  },
  { name: "quest", asks: "Which one was stronger?", words: "JND by QUEST+", laws: "one", isJudged: true, trials: 40 },
  {
    name: "magnitude",
    asks: "How strong was it?",
    words: "A number for how strong it was",
    laws: "one",
    levels: "-0.6, -0.4, -0.2, 0, 0.3, 0.6",
    trials: 6,
  },
  {
    name: "rating",
    asks: "How much did it feel like skin?",
    words: "A rating of each on seven steps",
    laws: "some",
    trials: 6,
    more: "points = 7",
  },
];

export interface DraftLaw {
  readonly name: string; // path within the workspace
  readonly unit: string; // "m" or "rad", of its axis
}

/** What the form asks for. */
export interface ProtocolDraft {
  name: string;
  title: string;
  design: DesignKind;
  laws: readonly DraftLaw[];
  signal: string; // one of the laws
  question: string;
  instructions: string;
  consent: string;
  ends: string; // words of a rating's two ends, with a comma between
  trials: number;
  practice: number;
  levels: string;
  interval_s: number; // empty, NaN: as the design has it
  breakEvery: number;
  device: string;
  language: string;
  from: number; // where the tool is, in mm or deg; NaN: nobody says
  to: number;
}

// What JSON escapes, TOML does alike.
const quoted = (text: string): string => JSON.stringify(text);

const stemOf = (path: string): string => path.replace(/^.*\//, "").replace(/\.law\.toml$/, "");

/** A name for each law that no other has. */
export function sampleNames(laws: readonly DraftLaw[]): string[] {
  const names: string[] = [];
  for (const { name } of laws) {
    const stem = stemOf(name);
    let free = stem;
    for (let k = 2; names.includes(free); ++k) free = `${stem}-${k}`;
    names.push(free);
  }
  return names;
}

/** In what positions along an axis are typed. */
export function shownUnit(laws: readonly DraftLaw[]): string {
  return laws[0]?.unit === "rad" ? "deg" : "mm";
}

function scaleOf(draft: ProtocolDraft): string[] {
  const { name, levels } = draft.design;
  const has = name === "staircase" || name === "quest" || levels !== undefined;
  if (!has) return [];
  const typed = draft.levels.split(/[\s,;]+/).filter((it) => it !== "");
  return [
    "",
    "[scale]",
    'vary = "force"                # or parameters of the law, as ["damping"]',
    ...(levels === undefined ? [] : [`levels = [${typed.join(", ")}]   # a comparison is 1 + level of the standard`]),
    ...(name === "constant" ? ['shape = "gaussian"'] : []),
    ...(name === "staircase"
      ? [
          "staircase = { up = 1, down = 2, start = 0.4, steps = [0.4, 0.2, 0.1], reversals = 12, dropped = 4, least = 0.005, most = 1.0 }",
        ]
      : []),
    ...(name === "quest" ? [`quest = { trials = ${draft.trials}, expected_jnd = 0.1 }`] : []),
  ];
}

/** The protocol of what the form says, as a person would write it. */
export function protocolText(draft: ProtocolDraft): string {
  const { design, laws } = draft;
  const names = sampleNames(laws);
  const hasMotion = Number.isFinite(draft.from) && Number.isFinite(draft.to);
  const isCompared = laws.length > 1 && design.levels === undefined && design.name !== "rating";
  const unit = shownUnit(laws);
  const signal = names[laws.findIndex((it) => it.name === draft.signal)];
  const ends = draft.ends.split(",").map((it) => it.trim());
  const text = (key: string, value: string): string[] => (value.trim() ? [`${key} = ${quoted(value.trim())}`] : []);
  const lines = [
    `name = ${quoted(draft.name || "a comparison")}`,
    ...text("title", draft.title),
    `design = ${quoted(design.name)}`,
    ...text("question", draft.question),
    ...text("instructions", draft.instructions),
    ...text("consent", draft.consent),
    ...(draft.language === "en" ? [] : text("language", draft.language)),
    ...(design.hasSignal && signal ? [`signal = ${quoted(signal)}`] : []),
    ...(design.more ? [design.more] : []),
    ...(design.name === "rating" && ends.length === 2 ? [`ends = [${ends.map(quoted).join(", ")}]`] : []),
    ...(design.name === "quest" ? [] : [`trials = ${draft.trials}`]),
    ...(draft.practice > 0 ? [`practice = ${draft.practice}`] : []),
    ...(draft.practice > 0 && design.isJudged ? ["feedback = true"] : []),
    ...(draft.interval_s > 0 ? [`interval = { value = ${draft.interval_s}, unit = "s" }`] : []),
    ...text("device", draft.device),
    ...(isCompared && hasMotion
      ? ['loudness = "felt-rms"         # equally strong, so that strength gives nothing away']
      : []),
    ...(draft.breakEvery > 0 ? [`break = { every = ${draft.breakEvery}, at_least = { value = 30, unit = "s" } }`] : []),
    ...laws.flatMap((law, k) => ["", "[[sample]]", `name = ${quoted(names[k]!)}`, `law = ${quoted(law.name)}`]),
    ...scaleOf(draft),
    ...(hasMotion
      ? [
          "",
          "[motion]                      # of rehearsals, and of what makes laws equally strong",
          `from = { value = ${draft.from}, unit = "${unit}" }`,
          `to = { value = ${draft.to}, unit = "${unit}" }`,
          'seconds = { value = 4.2, unit = "s" }',
        ]
      : []),
  ];
  return `${lines.join("\n")}\n`;
}
