const setting = "kerf single keys";

/** Keys without Ctrl or Alt can be switched off, for those whose speech or reader sends letters. */
export function singleKeysOn(): boolean {
  return localStorage.getItem(setting) !== "off";
}

export function switchSingleKeys(on: boolean): void {
  localStorage.setItem(setting, on ? "on" : "off");
}
