/** The stretch of time that stacked plots show, and the cursor in it. All in seconds. */
export class TimeRange {
  from = 0;
  to = 1;
  first = 0; // nothing is shown before
  last = 1; // nor after
  shortest = 1e-3;
  cursor: number | null = null;
  /** Follows the running loop: only the cursor can be moved. */
  following = false;

  constructor(
    private readonly changed: () => void,
    private readonly pointed: () => void,
    /** Somebody zooms while it follows: by how much. */
    private readonly zoomedWhileFollowing: (factor: number) => void = () => {},
  ) {}

  get span(): number {
    return this.to - this.from;
  }

  bound(first: number, last: number, shortest: number): void {
    this.first = first;
    this.last = Math.max(last, first + shortest);
    this.shortest = shortest;
  }

  /** The newest stretch; the cursor stays where it is on the screen. */
  follow(to: number, span: number): void {
    const moved = to - this.to;
    if (this.cursor !== null) this.cursor += moved;
    this.to = to;
    this.from = to - span;
  }

  show(from: number, to: number): void {
    if (this.following) return;
    const span = Math.min(Math.max(to - from, this.shortest), this.last - this.first);
    let start = (from + to - span) / 2;
    start = Math.max(this.first, Math.min(start, this.last - span));
    if (start === this.from && start + span === this.to) return;
    this.from = start;
    this.to = start + span;
    this.changed();
  }

  whole(): void {
    this.show(this.first, this.last);
  }

  /** A factor below 1 shows less; the time `at` stays where it is. */
  zoom(factor: number, at = this.cursor ?? (this.from + this.to) / 2): void {
    if (this.following) return this.zoomedWhileFollowing(factor);
    const span = Math.min(Math.max(this.span * factor, this.shortest), this.last - this.first);
    const share = Math.min(1, Math.max(0, (at - this.from) / this.span));
    this.show(at - share * span, at - share * span + span);
  }

  /** By a share of what is shown. */
  pan(share: number): void {
    this.panBy(share * this.span);
  }

  panBy(seconds: number): void {
    const by = Math.min(Math.max(seconds, this.first - this.from), this.last - this.to);
    this.show(this.from + by, this.to + by);
  }

  point(at: number | null): void {
    this.cursor = at === null ? null : Math.min(Math.max(at, this.from), this.to);
    this.pointed();
  }
}
