// What was begun and is not saved: it outlives reloads, tabs and a studio that is started anew.

/**
 * In the tab, and where another one finds it when this one is closed; null: no longer. Of two tabs with one key the last
 * one that has changed something is found; none of them takes away what the other one has kept.
 */
export function keep(key: string, value: unknown): void {
  try {
    const before = sessionStorage.getItem(key);
    for (const store of [sessionStorage, localStorage]) {
      if (value !== null) store.setItem(key, JSON.stringify(value));
      else if (store.getItem(key) === before) store.removeItem(key);
    }
  } catch {
    // a browser that keeps nothing: it lives as long as the page does
  }
}

/** As keep() had it, of this tab or else of the last one. */
export function kept(key: string): unknown {
  try {
    const text = sessionStorage.getItem(key) ?? localStorage.getItem(key);
    if (text !== null) sessionStorage.setItem(key, text);
    return JSON.parse(text ?? "null");
  } catch {
    return null;
  }
}
