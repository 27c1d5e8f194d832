import type { Knots } from "../../api/editor";
import type { WorkspaceLaw } from "../../api/workspace";
import { labelled, select, setOptions } from "../../ui/dom";
import type { Context } from "../../ui/view";
import type { Drawing } from "../drawing";
import { shifted } from "../knots";
import { lawsToPick } from "../../laws";

/** Breakpoints of a law file, and from where its penetration counts. */
interface LawKnots extends Knots {
  contact_position: number;
  closing_direction: number;
}

/** A choice among the piecewise laws of the folder that fit the axis; takes over the breakpoints of one. */
export function startFrom(context: Context, drawing: Drawing, taken: () => void): HTMLElement {
  const { curve } = drawing;
  let laws: WorkspaceLaw[] = [];
  const take = async (id: string, name: string): Promise<void> => {
    try {
      const { contact_position, closing_direction, penetration, closing, opening } = await context.api.get<LawKnots>(
        "/api/editor/law",
        { id },
      );
      if (closing_direction !== curve.closing_direction) throw new Error(`${name} engages the other way round.`);
      const by = (contact_position - curve.contact_position) * curve.closing_direction;
      drawing.set(shifted({ penetration, closing, opening }, by));
      taken();
      context.say(
        by === 0 ? `Breakpoints of ${name}.` : `Breakpoints of ${name}, moved to the contact of this recording.`,
      );
    } catch (error) {
      context.complain(error);
    }
  };
  const node = select([], "", (id) => {
    const law = laws.find((it) => it.id === id);
    node.value = "";
    if (law) void take(law.id, law.name);
  });
  context.onFolder((workspace) => {
    laws = lawsToPick(workspace).filter(
      (it) => it.breakpoints && it.position_unit === curve.position_unit && it.force_unit === curve.force_unit,
    );
    setOptions(node, [
      { value: "", text: laws.length > 0 ? "choose" : "none here fits" },
      ...laws.map((it) => ({ value: it.id, text: it.name })),
    ]);
    node.disabled = laws.length === 0;
  });
  return labelled("Start from law", node);
}
