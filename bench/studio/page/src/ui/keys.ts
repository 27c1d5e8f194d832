/** Keys belong to what has the focus: text fields, lists, and for Space and Enter buttons and links as well. */
export function isTyping(event: KeyboardEvent): boolean {
  const target = event.target instanceof HTMLElement ? event.target : null;
  if (!target) return false;
  if (target.isContentEditable || target.closest("input, select, textarea, [role=slider], [role=textbox]")) return true;
  return (event.key === " " || event.key === "Enter") && target.closest("button, a, summary, [role=tab]") !== null;
}
