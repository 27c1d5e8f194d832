/**
 * A sentence of the program's for whoever has no terminal: 'kerf prepare --cycles 2-8' is 'Prepare' under Work, and what
 * stands in brackets for an option alone is left out.
 */
export function inPageWords(text: string): string {
  const verb = (_: string, first: string, rest: string): string => `'${first.toUpperCase()}${rest}' under Work`;
  return text
    .replace(/ \(--[^)]*\)/g, "")
    .replace(/'kerf (\w)([a-z]*)(?: [^']*)?'/g, verb)
    .replace(/--([a-z]+(?:-[a-z]+)*)/g, (_, name: string) => `the option '${name.replaceAll("-", " ")}'`);
}
