import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { displayName } from "../result/format";
import { scan } from "../ui/state";
import * as editing from "./editing";
import { AlignHandles, BoxHandles, rowsOf } from "./handles";
import type { ShownJoint } from "./joints_object";
import type { Pane, PaneName } from "./panes";
import { JOINTS, type Joint } from "./skeleton";
import * as state from "./state";
import * as tools from "./tools";
import { EditorView } from "./view";
import "./editor.css";

const NAMES: Record<PaneName, string> = { front: "Front", side: "Left side", free: "Any side" };
/** Metres that an arrow key moves a joint, and with Shift; share of a movement that Shift leaves. */
const STEP_M = 0.01;
const FINE_STEP_M = 0.001;
const FINE = 0.2;
const TURN = Math.PI / 24;

/** Joints where they are drawn; those that have no place yet stand where the posed body has them. */
function shownJoints(view: EditorView): ShownJoint[] {
  const keypoints = state.keypoints.value;
  const found = new Map(state.base.value?.found.map((each) => [each.joint, each.source]));
  const touched = editing.touched();
  const posed = new Map(state.preview.value?.joints.map((each) => [each.name, each.body_m]));
  return JOINTS.flatMap((joint) => {
    const placed = keypoints?.joints[joint];
    const look = { joint, locked: state.locked.value.has(joint), selected: state.selected.value === joint };
    if (placed) {
      const moving = state.dragged.value && placed !== state.edited.value.keypoints?.joints[joint];
      const source = moving || touched.has(joint) ? "user" : (found.get(joint) ?? "user");
      return [{ ...look, position: view.world(placed.position), confidence: placed.confidence ?? 1, source }];
    }
    const guess = posed.get(joint);
    if (!guess) return [];
    const position = view.world([0, 0, 0]).set(...(guess as [number, number, number]));
    return [{ ...look, position, confidence: 0, source: "none" as const }];
  });
}

/** Moves one joint of one pane with the pointer. */
class JointDrag {
  private readonly from;
  private readonly grip;

  constructor(
    private readonly view: EditorView,
    private readonly pane: Pane,
    private readonly target: ShownJoint,
    x: number,
    y: number,
  ) {
    this.from = target.position.clone();
    this.grip = { x, y };
  }

  move(x: number, y: number, fine: boolean): void {
    // Between the grip and the pointer, so that a joint does not jump to where it was taken.
    const scale = fine ? FINE : 1;
    const at = this.pane.pixel(this.from);
    const [u, v] = [at.x + scale * (x - this.grip.x), at.y + scale * (y - this.grip.y)];
    const position = this.pane.pointAt(u, v, this.from);
    if (!position) return;
    const { origin, direction } = this.pane.ray(u, v);
    const sight = { origin: this.view.scan(origin), direction: this.view.scanDirection(direction) };
    editing.drag(this.target.joint, this.view.scan(position), sight);
  }

  end(): void {
    void editing.drop(this.target.joint);
  }
}

/** A closed line drawn on a pane. */
interface Lasso {
  pane: PaneName;
  points: [number, number][];
}

const LASSO_STEP = 4;

export function EditorPane() {
  const root = useRef<HTMLDivElement>(null);
  const view = useSignal<EditorView | null>(null);
  const failed = useSignal("");
  const lasso = useSignal<Lasso | null>(null);
  const hovered = useSignal<{ pane: PaneName; joint: Joint } | null>(null);
  /** The joint whose name a pane shows: that under the pointer, else the chosen one. */
  const named = (pane: PaneName) =>
    state.tool.value !== "joints"
      ? null
      : hovered.value?.pane === pane
        ? hovered.value.joint
        : state.selected.value;

  useEffect(() => {
    const element = (name: PaneName) => root.current!.querySelector<HTMLElement>(`[data-pane=${name}]`)!;
    const elements = { front: element("front"), side: element("side"), free: element("free") };
    try {
      // Joints are taken before the camera is.
      for (const each of Object.values(elements)) each.addEventListener("pointerdown", onPointerDown);
      view.value = new EditorView(root.current!.querySelector("canvas")!, elements);
    } catch (error) {
      failed.value = error instanceof Error ? error.message : String(error);
    }
    return () => view.peek()?.dispose();
  }, []);

  useSignalEffect(() => {
    const opened = scan.value;
    if (view.value && opened)
      view.value.setScan(state.rest.value ?? opened.mesh, state.coarse.value, opened.origin);
  });
  useSignalEffect(() => {
    const matrix = state.bodyFromScan.value;
    if (view.value && matrix && scan.value) view.value.setBodyFromScan(matrix);
  });
  useSignalEffect(() => {
    const shown = state.tool.value === "joints" && state.showBody.value;
    view.value?.setBody(shown ? (state.preview.value?.body ?? null) : null);
  });
  useSignalEffect(() => {
    if (!view.value) return;
    view.value.setJoints(
      state.tool.value === "joints" && state.bodyFromScan.value ? shownJoints(view.value) : [],
    );
  });
  useEffect(() => {
    const current = view.value;
    if (current) current.onDrawn = () => placeNames(root.current!, current);
  }, [view.value]);
  // Other names stand elsewhere.
  useEffect(() => {
    if (view.value) placeNames(root.current!, view.value);
  });
  useSignalEffect(() => {
    // Undo, redo and new edits pose the body anew; a drag does so itself.
    const edited = state.edited.value.keypoints && state.bodyFromScan.value;
    if (edited && state.tool.value === "joints" && !state.dragged.peek()) editing.refresh();
  });
  const crops = JSON.stringify(state.edited.value.crops);
  useEffect(() => void editing.showRest(), [crops]);
  useSignalEffect(() => {
    const current = view.value;
    if (!current || !state.bodyFromScan.value) return;
    if (state.tool.value === "align") {
      const handles = new AlignHandles(current, (matrix) => editing.align(matrix, "Align by hand"));
      tools.setAlign(handles);
      return () => {
        tools.setAlign(null);
        handles.dispose();
      };
    }
    if (state.tool.value === "cut" && state.cutter.value === "box") {
      const handles = new BoxHandles(current);
      tools.setBox(handles);
      return () => {
        tools.setBox(null);
        handles.dispose();
      };
    }
  });

  function onPointerDown(this: HTMLElement, event: PointerEvent): void {
    const current = view.peek();
    const name = this.dataset.pane as PaneName;
    if (!current || event.button !== 0) return;
    this.focus({ preventScroll: true });
    const pane = current.pane(name);
    if (state.tool.peek() === "cut" && state.cutter.peek() === "lasso") {
      event.stopImmediatePropagation();
      draw(this, pane, event);
      return;
    }
    if (state.tool.peek() !== "joints") return;
    const joint = current.jointAt(pane, event.offsetX, event.offsetY, event.pointerType);
    if (!joint) return;
    event.stopImmediatePropagation();
    state.selected.value = joint.joint;
    if (joint.locked) return;
    const drag = new JointDrag(current, pane, joint, event.offsetX, event.offsetY);
    current.setForemost(name);
    follow(
      this,
      event,
      (moved) => drag.move(moved.offsetX, moved.offsetY, moved.shiftKey),
      () => {
        current.setForemost(null);
        drag.end();
      },
    );
  }

  function onPointerMove(event: PointerEvent): void {
    const current = view.peek();
    const element = event.currentTarget as HTMLElement;
    const pane = element.dataset.pane as PaneName;
    if (!current || event.buttons !== 0 || state.tool.peek() !== "joints") return;
    const joint = current.jointAt(current.pane(pane), event.offsetX, event.offsetY, event.pointerType);
    element.classList.toggle("over-joint", joint !== null && !joint.locked);
    if (joint?.joint !== hovered.peek()?.joint) hovered.value = joint && { pane, joint: joint.joint };
  }

  /** Follows a pointer until it is lifted. */
  function follow(
    element: HTMLElement,
    { pointerId }: PointerEvent,
    move: (event: PointerEvent) => void,
    end: () => void,
  ): void {
    element.setPointerCapture(pointerId);
    const onMove = (event: PointerEvent) => event.pointerId === pointerId && move(event);
    const onEnd = (event: PointerEvent) => {
      if (event.pointerId !== pointerId) return;
      element.removeEventListener("pointermove", onMove);
      element.removeEventListener("pointerup", onEnd);
      element.removeEventListener("pointercancel", onEnd);
      end();
    };
    element.addEventListener("pointermove", onMove);
    element.addEventListener("pointerup", onEnd);
    element.addEventListener("pointercancel", onEnd);
  }

  function draw(element: HTMLElement, pane: Pane, event: PointerEvent): void {
    lasso.value = { pane: pane.name, points: [[event.offsetX, event.offsetY]] };
    follow(
      element,
      event,
      ({ offsetX, offsetY }) => {
        const points = lasso.value?.points ?? [];
        const [x, y] = points.at(-1) ?? [0, 0];
        if (Math.hypot(offsetX - x, offsetY - y) < LASSO_STEP) return;
        lasso.value = { pane: pane.name, points: [...points, [offsetX, offsetY]] };
      },
      () => {
        const points = lasso.value?.points ?? [];
        lasso.value = null;
        const current = view.peek();
        if (!current || points.length < 3) return;
        editing.cut({
          remove: state.cutSide.peek(),
          clip_from_scan: rowsOf(pane.clipFromWorld().multiply(current.bodyFromScan())),
          polygon: points.map(([x, y]) => pane.clip(x, y)),
        });
      },
    );
  }

  function onKeyDown(event: KeyboardEvent): void {
    const current = view.peek();
    const name = (event.currentTarget as HTMLElement).dataset.pane as PaneName | undefined;
    if (!current || !name || event.ctrlKey || event.metaKey || event.altKey) return;
    const pane = current.pane(name);
    const [x, y] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[
      event.key
    ] ?? [0, 0];
    const joints = state.tool.value === "joints";
    if (x !== 0 || y !== 0) {
      if (joints) nudge(current, pane, x!, y!, event.shiftKey);
      else pane.orbit(x! * TURN, -y! * TURN);
    } else if (joints && (event.key === "," || event.key === ".")) {
      const step = event.key === "." ? 1 : -1;
      const at = JOINTS.indexOf(state.selected.value) + step + JOINTS.length;
      state.selected.value = JOINTS[at % JOINTS.length]!;
    } else if (joints && event.key === "l") editing.lock(state.selected.value);
    else if (event.key === "f") current.fit();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Moves the chosen joint in the plane of a pane. */
  function nudge(current: EditorView, pane: Pane, x: number, y: number, fine: boolean): void {
    const joint = shownJoints(current).find((each) => each.selected);
    if (!joint || joint.locked) return;
    const { right, up } = pane.axes();
    const step = fine ? FINE_STEP_M : STEP_M;
    const position = joint.position
      .clone()
      .addScaledVector(right, x * step)
      .addScaledVector(up, y * step);
    editing.drag(joint.joint, current.scan(position), null);
    void editing.drop(joint.joint);
  }

  return (
    <div class="editor" ref={root}>
      <canvas />
      {(["front", "side", "free"] as const).map((name) => (
        <div
          key={name}
          class={`pane ${name}`}
          data-pane={name}
          // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard moves joints and the camera here
          tabIndex={0}
          role="application"
          onKeyDown={onKeyDown}
          onPointerMove={onPointerMove}
          onPointerLeave={() => {
            hovered.value = null;
          }}
          aria-label={`${NAMES[name]}. ${help(state.tool.value, state.selected.value)}`}
        >
          <span class="pane-name">{NAMES[name]}</span>
          <span class="joint-name" data-joint={named(name)} aria-hidden="true" hidden>
            {displayName(named(name) ?? "")}
          </span>
          {lasso.value?.pane === name && (
            <svg class="lasso" aria-hidden="true">
              <polygon points={lasso.value.points.join(" ")} />
            </svg>
          )}
        </div>
      ))}
      {failed.value && (
        <p class="view-note" role="alert">
          The editor could not start ({failed.value}). Switch on hardware acceleration or WebGL.
        </p>
      )}
    </div>
  );
}

/** Puts each pane's name next to its joint. */
function placeNames(root: HTMLElement, view: EditorView): void {
  for (const label of root.querySelectorAll<HTMLElement>(".joint-name")) {
    const pane = view.pane(label.parentElement!.dataset.pane as PaneName);
    const place = view.placeOf(label.dataset.joint);
    label.hidden = !place;
    if (!place) continue;
    const { x, y } = pane.pixel(place);
    label.classList.toggle("leftward", x > pane.element.clientWidth / 2);
    label.style.left = `${x}px`;
    label.style.top = `${y}px`;
  }
}

function help(tool: state.Tool | null, joint: Joint): string {
  if (tool === "joints")
    return `Arrow keys move ${displayName(joint).toLowerCase()}, with Shift finely; comma and full stop choose another joint, L locks it, F shows everything.`;
  return "Arrow keys turn the view, F shows everything.";
}
