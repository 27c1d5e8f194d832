import { byId } from "./notice";

const setting = "kerf side";

/** The pages and files at the left: beside the page where there is room, over it where there is not. */
export class Side {
  private readonly opener = byId("side_opener");
  private readonly narrow = matchMedia("(max-width: 860px)");
  private isOpen = !this.narrow.matches && localStorage.getItem(setting) !== "closed";

  constructor(list: HTMLElement) {
    byId("side").append(list);
    this.opener.addEventListener("click", () => this.toggle());
    this.narrow.addEventListener("change", () =>
      this.put(!this.narrow.matches && localStorage.getItem(setting) !== "closed"),
    );
    addEventListener("hashchange", () => {
      if (this.narrow.matches) this.put(false);
    });
    this.put(this.isOpen);
  }

  toggle(): void {
    this.put(!this.isOpen);
    if (!this.narrow.matches) localStorage.setItem(setting, this.isOpen ? "open" : "closed");
  }

  open(): void {
    if (!this.isOpen) this.toggle();
  }

  private put(isOpen: boolean): void {
    this.isOpen = isOpen;
    document.body.classList.toggle("without_side", !isOpen);
    this.opener.setAttribute("aria-expanded", String(isOpen));
  }
}
