/**
 * What stands of a recording in the address. The tabs share these keys: a cycle that is chosen in one is the one that
 * the others show. A tab that needs another key adds it here.
 */
export const stateKeys = {
  from: "from", // the stretch of time that is shown [s]
  to: "to",
  traces: "traces", // names, by commas; none: those of the axis
  over: "over", // ids of the recordings laid over it, by commas
  align: "align", // "start" or "cycle": where they lie over each other
  axis: "axis", // index
  cycle: "cycle", // number of the one that is chosen
  loops: "loops", // "all", "one" or "average"
  beside: "beside", // recordings side by side instead of over each other
  fit: "fit", // id of the fit.json that is shown
  law: "law", // model or id of a law that is looked at
  laws: "laws", // several, by commas
  chart: "chart", // id of the chart.json or choose.json that is shown
} as const;
