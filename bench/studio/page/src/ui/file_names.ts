/** Why a new file cannot be called that, as the studio refuses it; empty: it can. */
export function whyNoName(name: string): string {
  if (/^[A-Za-z0-9][A-Za-z0-9_.-]{0,79}$/.test(name)) return "";
  return "A name has 1 to 80 letters, digits, '_', '-' or '.', the first a letter or digit.";
}
