import { ApiError } from "../../api/api";
import type { DrawnLaw, LawError } from "../../api/editor";
import { button, element, labelled } from "../../ui/dom";
import type { Context } from "../../ui/view";
import type { Drawing } from "../drawing";

/** Writes the law into the workspace; an existing file is replaced only when that is asked for. */
export function savePanel(context: Context, drawing: Drawing, axis: number, name: string): HTMLElement {
  const input = element("input", {
    type: "text",
    maxlength: 80,
    value: name,
    spellcheck: "false",
    autocomplete: "off",
  });
  const said = element("p", { class: "said", role: "status" });
  const save = async (replace: boolean): Promise<void> => {
    const law: DrawnLaw = {
      name: input.value.trim(),
      recording: drawing.curve.recording,
      axis,
      knots: drawing.knots,
      replace,
    };
    said.replaceChildren();
    try {
      const answer = await context.api.post<{ id: string; name: string; error: LawError }>("/api/editor/save", law);
      context.lookAtFolder();
      said.append(
        element("span", {}, `Saved as ${answer.name}. To try it: `),
        element("code", {}, `kerf check ${answer.name}`),
      );
    } catch (error) {
      if (!(error instanceof ApiError && error.status === 409) || replace) return context.complain(error);
      const yes = button("Replace it", () => void save(true));
      const no = button("Keep it", () => {
        said.replaceChildren();
        input.focus();
      });
      said.append(element("span", {}, `${law.name}.law.toml is there already.`), yes, no);
      yes.focus();
    }
  };
  return element(
    "form",
    {
      class: "save",
      submit: (event: Event) => {
        event.preventDefault();
        void save(false);
      },
    },
    labelled("Name", input),
    element("button", { type: "submit", class: "firm" }, "Save law"),
    said,
  );
}
