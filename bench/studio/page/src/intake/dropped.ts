// Files may be dropped anywhere on the studio: they are kept here until the page that takes them in is there.

let waiting: File[] = [];
let taker: ((files: File[]) => void) | null = null;

const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;

/** Watches for drops for good; `go` brings the page that takes files in. */
export function watchDrops(go: () => void): void {
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault(); // else the browser opens the file in place of the studio
    document.body.classList.add("files_over");
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) document.body.classList.remove("files_over");
  });
  addEventListener("drop", (event) => {
    document.body.classList.remove("files_over");
    if (!hasFiles(event)) return;
    event.preventDefault();
    take([...(event.dataTransfer?.files ?? [])]);
    go();
  });
}

function take(files: File[]): void {
  if (taker) taker(files);
  else waiting.push(...files);
}

/** Whoever takes files in is given those that wait, and all after them, until the signal. */
export function onDropped(listener: (files: File[]) => void, signal: AbortSignal): void {
  taker = listener;
  signal.addEventListener("abort", () => {
    if (taker === listener) taker = null;
  });
  if (waiting.length > 0) listener(waiting);
  waiting = [];
}
