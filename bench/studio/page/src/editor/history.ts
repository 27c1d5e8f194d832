/** What was, to go back to and forth again. Steps of one tag that follow each other are one: a drag, some nudges. */
export class History<Value> {
  private readonly before: Value[] = [];
  private after: Value[] = [];
  private tag = "";

  constructor(
    private value: Value,
    private readonly most = 500,
  ) {}

  get now(): Value {
    return this.value;
  }
  get canUndo(): boolean {
    return this.before.length > 0;
  }
  get canRedo(): boolean {
    return this.after.length > 0;
  }

  record(next: Value, tag = ""): void {
    if (tag === "" || tag !== this.tag) {
      this.before.push(this.value);
      if (this.before.length > this.most) this.before.shift();
    }
    this.after = [];
    this.value = next;
    this.tag = tag;
  }

  /** What is now, as it is called from here on: no step of its own. */
  rename(value: Value): void {
    this.value = value;
    this.tag = "";
  }

  undo(): boolean {
    return this.step(this.before, this.after);
  }
  redo(): boolean {
    return this.step(this.after, this.before);
  }

  private step(from: Value[], to: Value[]): boolean {
    const value = from.pop();
    if (value === undefined) return false;
    to.push(this.value);
    this.value = value;
    this.tag = "";
    return true;
  }
}
