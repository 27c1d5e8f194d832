/** A name that every file system takes: letters, digits, "-", "_"; what is another becomes "-". */
export function fileName(name: string, ending: string): string {
  const stem = name
    .normalize("NFKD")
    .replace(/[\u0300-\u036f]/g, "")
    .replace(/[^A-Za-z0-9_]+/g, "-")
    .replace(/^[-_]+|[-_]+$/g, "")
    .slice(0, 60)
    .replace(/-+$/, "");
  const taken = /^(con|prn|aux|nul|com\d|lpt\d)$/i; // by an operating system
  return `${stem === "" || taken.test(stem) ? `kerf-${stem || "plot"}` : stem}.${ending}`;
}

/** Gives the browser a file to keep. */
export function download(content: Blob | string, name: string, type = "text/plain"): void {
  const blob = typeof content === "string" ? new Blob([content], { type: `${type};charset=utf-8` }) : content;
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60000); // not before it was read
}
