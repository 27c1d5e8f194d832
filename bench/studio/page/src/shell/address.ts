// The address of the page: `#/recording/1f3a/time?from=2&to=3`. Whatever is seen can be seen again by it.

/** Where a page is, and the state of what it shows. */
export interface Address {
  readonly view: string;
  readonly id: string;
  readonly tab: string; // of a recording
  readonly state: Readonly<Record<string, string>>;
}

/** Pages of earlier versions that are tabs of a recording now. */
const oldTabs: Readonly<Record<string, string>> = { recordings: "time", editor: "law" };

export function readAddress(hash: string): Address {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split(/\?(.*)/s);
  const [view = "", id = "", tab = ""] = path.split("/").map(decoded);
  const state = Object.fromEntries(new URLSearchParams(query));
  const oldTab = oldTabs[view];
  if (oldTab !== undefined && id) return { view: "recording", id, tab: oldTab, state };
  return { view, id, tab, state };
}

export function writeAddress({ view, id, tab, state }: Address): string {
  const path = [view, id, tab].map(encodeURIComponent).join("/").replace(/\/+$/, "");
  const query = new URLSearchParams(state).toString().replaceAll("%2C", ",");
  return `#/${path}${query ? `?${query}` : ""}`;
}

/** The address with some of its state changed; null takes a key out. */
export function withState(address: Address, changed: Readonly<Record<string, string | null>>): Address {
  const state: Record<string, string> = {};
  for (const [key, value] of Object.entries({ ...address.state, ...changed })) if (value !== null) state[key] = value;
  return { ...address, state };
}

/** Whether the same tab of the same page shows both: what differs is state alone. */
export function isSamePlace(one: Address, other: Address): boolean {
  return one.view === other.view && one.id === other.id && one.tab === other.tab;
}

function decoded(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part; // a lone "%"
  }
}
