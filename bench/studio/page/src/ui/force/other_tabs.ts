/**
 * What tabs of the same studio tell each other: a tab that is older than the studio asks for the token of the one that
 * runs. Only pages of this origin hear it, and a tab answers only while `knows` says that its own token holds.
 */
export class OtherTabs {
  private readonly channel = new BroadcastChannel("kerf studio");
  private waiting: ((token: string) => void) | null = null;

  constructor(token: string, knows: () => boolean) {
    this.channel.addEventListener("message", ({ data }: MessageEvent<{ token?: string }>) => {
      if (data.token === undefined) {
        if (knows()) this.channel.postMessage({ token });
      } else {
        this.waiting?.(data.token);
      }
    });
  }

  /** The token that another tab knows; empty if none has said it within half a second. */
  ask(): Promise<string> {
    return new Promise((go) => {
      this.waiting = go;
      this.channel.postMessage({});
      setTimeout(() => go(""), 500);
    });
  }
}
