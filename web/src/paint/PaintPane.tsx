import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { bodyFromScan } from "../editor/state";
import { scan } from "../ui/state";
import { colourOf, SIDES } from "./labels";
import * as painting from "./painting";
import type { Side } from "./requests";
import * as state from "./state";
import { PaintView } from "./view";
import "../editor/editor.css";
import "./paint.css";

const NAMES: Record<Side, string> = { scan: "Scan", template: "Body" };
const TURN = Math.PI / 24;
const ZOOM = 1.15;
/** Pixels between two corners of a lasso. */
const LASSO_STEP = 4;

type Place = [number, number];

/** Where the pointer, or the keyboard's cursor, is. */
interface Cursor {
  side: Side;
  at: Place;
}

function step(factor: number): void {
  const size = Math.round(state.radius.value * factor + Math.sign(factor - 1));
  state.radius.value = Math.min(Math.max(size, state.SMALLEST), state.LARGEST);
}

export function PaintPane() {
  const root = useRef<HTMLDivElement>(null);
  const view = useSignal<PaintView | null>(null);
  const failed = useSignal("");
  const cursor = useSignal<Cursor | null>(null);
  const lasso = useSignal<{ side: Side; points: Place[] } | null>(null);
  const touches = useRef(new Set<number>());

  useEffect(() => {
    const element = (side: Side) => root.current!.querySelector<HTMLElement>(`[data-pane=${side}]`)!;
    const elements = { scan: element("scan"), template: element("template") };
    try {
      // The brush is asked before the camera is.
      for (const each of Object.values(elements)) {
        each.addEventListener("pointerdown", onPointerDown);
        each.addEventListener("wheel", onWheel, { passive: false });
      }
      view.value = new PaintView(root.current!.querySelector("canvas")!, elements);
    } catch (error) {
      failed.value = error instanceof Error ? error.message : String(error);
    }
    return () => view.peek()?.dispose();
  }, []);

  useSignalEffect(() => {
    const [mesh, opened, matrix] = [state.scanMesh.value, scan.value, bodyFromScan.value];
    if (view.value && mesh && opened && matrix) view.value.setScan(mesh, opened.origin, matrix);
  });
  useSignalEffect(() => {
    if (view.value && state.templateMesh.value) view.value.setTemplate(state.templateMesh.value);
  });
  useSignalEffect(() => {
    state.revision.value;
    if (state.scanMesh.value && state.templateMesh.value) view.value?.colour(state.labels.value);
  });
  useSignalEffect(() => view.value?.setTurning(state.tool.value === "turn"));
  useSignalEffect(() => {
    if (view.value) view.value.together = state.together.value;
  });

  function onWheel(this: HTMLElement, event: WheelEvent): void {
    if (state.tool.peek() !== "brush" || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    step(event.deltaY < 0 ? 1.12 : 1 / 1.12);
  }

  function onPointerDown(this: HTMLElement, event: PointerEvent): void {
    const current = view.peek();
    const side = this.dataset.pane as Side;
    const tool = state.tool.peek();
    if (event.pointerType === "touch") {
      const { pointerId } = event;
      touches.current.add(pointerId);
      const lift = (lifted: PointerEvent) => {
        if (lifted.pointerId !== pointerId) return;
        touches.current.delete(pointerId);
        removeEventListener("pointerup", lift);
        removeEventListener("pointercancel", lift);
      };
      addEventListener("pointerup", lift);
      addEventListener("pointercancel", lift);
      if (touches.current.size > 1) {
        painting.abandon();
        lasso.value = null;
        return;
      }
    }
    if (!current || event.button !== 0 || tool === "turn") return;
    // A second finger turns the view, so the camera hears of the first one too.
    if (event.pointerType !== "touch") event.stopImmediatePropagation();
    this.focus({ preventScroll: true });
    const at: Place = [event.offsetX, event.offsetY];
    const camera = current.camera(side);
    const erase = event.shiftKey;
    if (tool === "part") {
      painting.strokeAtOnce(side, camera, { with: "part", way: [at] }, erase);
      return;
    }
    if (tool === "lasso") lasso.value = { side, points: [at] };
    else {
      painting.beginBrush(side, camera, erase);
      painting.brushTo(...at);
    }
    const { pointerId } = event;
    this.setPointerCapture(pointerId);
    const onMove = (moved: PointerEvent) => {
      if (moved.pointerId !== pointerId || touches.current.size > 1) return;
      const [x, y] = [moved.offsetX, moved.offsetY];
      if (tool === "brush") {
        painting.brushTo(x, y);
        return;
      }
      const points = lasso.value?.points;
      const [u, v] = points?.at(-1) ?? [x, y];
      if (points && Math.hypot(x - u, y - v) >= LASSO_STEP)
        lasso.value = { side, points: [...points, [x, y]] };
    };
    const onEnd = (ended: PointerEvent) => {
      if (ended.pointerId !== pointerId) return;
      this.removeEventListener("pointermove", onMove);
      this.removeEventListener("pointerup", onEnd);
      this.removeEventListener("pointercancel", onEnd);
      if (tool === "brush") painting.endBrush();
      else closeLasso(erase);
    };
    this.addEventListener("pointermove", onMove);
    this.addEventListener("pointerup", onEnd);
    this.addEventListener("pointercancel", onEnd);
  }

  function closeLasso(erase: boolean): void {
    const drawn = lasso.value;
    lasso.value = null;
    if (!drawn || drawn.points.length < 3 || !view.value) return;
    const camera = view.value.camera(drawn.side);
    painting.strokeAtOnce(drawn.side, camera, { with: "lasso", way: drawn.points }, erase);
  }

  function onPointerMove(event: PointerEvent): void {
    const side = (event.currentTarget as HTMLElement).dataset.pane as Side;
    cursor.value = event.pointerType === "touch" ? null : { side, at: [event.offsetX, event.offsetY] };
  }

  function onKeyDown(event: KeyboardEvent): void {
    const current = view.peek();
    const element = event.currentTarget as HTMLElement;
    const side = element.dataset.pane as Side;
    if (!current || event.ctrlKey || event.metaKey || event.altKey) return;
    const [x, y] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[
      event.key
    ] ?? [0, 0];
    const turning = event.shiftKey || state.tool.value === "turn";
    if ((x !== 0 || y !== 0) && turning) current.pane(side).orbit(x! * TURN, -y! * TURN);
    else if (x !== 0 || y !== 0) moveCursor(element, side, x!, y!);
    else if (event.key === " ") paintAtCursor(element, side);
    else if (event.key === "Enter") closeLasso(false);
    else if (event.key === "f") for (const each of SIDES) current.fit(each);
    else if (event.key === "+" || event.key === "=") current.zoom(side, ZOOM);
    else if (event.key === "-") current.zoom(side, 1 / ZOOM);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  function cursorIn(element: HTMLElement, side: Side): Place {
    return cursor.value?.side === side
      ? cursor.value.at
      : [element.clientWidth / 2, element.clientHeight / 2];
  }

  function moveCursor(element: HTMLElement, side: Side, x: number, y: number): void {
    const [u, v] = cursorIn(element, side);
    const way = Math.max(4, state.radius.value / 2);
    cursor.value = {
      side,
      at: [
        Math.min(Math.max(u + x * way, 0), element.clientWidth),
        Math.min(Math.max(v + y * way, 0), element.clientHeight),
      ],
    };
  }

  function paintAtCursor(element: HTMLElement, side: Side): void {
    const at = cursorIn(element, side);
    cursor.value = { side, at };
    const tool = state.tool.value;
    const camera = view.value!.camera(side);
    if (tool === "lasso") {
      const points = lasso.value?.side === side ? lasso.value.points : [];
      lasso.value = { side, points: [...points, at] };
    } else if (tool === "part") painting.strokeAtOnce(side, camera, { with: "part", way: [at] }, false);
    else if (tool === "brush")
      painting.strokeAtOnce(side, camera, { with: "brush", radius: state.radius.value, way: [at] }, false);
  }

  const colour =
    state.erasing.value || state.selected.value === 0 ? "currentColor" : colourOf(state.selected.value);
  return (
    <div class="painter" ref={root} data-strokes={state.done.value.length}>
      <canvas />
      {SIDES.map((side) => (
        <div
          key={side}
          class={`pane with-${state.tool.value}`}
          data-pane={side}
          // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard paints and turns here
          tabIndex={0}
          role="application"
          onKeyDown={onKeyDown}
          onPointerMove={onPointerMove}
          onPointerLeave={() => {
            cursor.value = null;
          }}
          aria-label={`${NAMES[side]}. ${HELP}`}
        >
          <span class="pane-name">{NAMES[side]}</span>
          <svg class="cursor" aria-hidden="true" style={{ color: colour }}>
            {cursor.value?.side === side && state.tool.value !== "turn" && (
              <circle
                cx={cursor.value.at[0]}
                cy={cursor.value.at[1]}
                r={state.tool.value === "brush" ? state.radius.value : 4}
              />
            )}
            {lasso.value?.side === side && <polygon points={lasso.value.points.join(" ")} />}
          </svg>
        </div>
      ))}
      {failed.value && (
        <p class="view-note" role="alert">
          The painter could not start ({failed.value}). Switch on hardware acceleration or WebGL.
        </p>
      )}
    </div>
  );
}

const HELP =
  "Arrow keys move the brush, the space bar paints, with the lasso it sets a corner and Enter closes it; with Shift the arrow keys turn the view; plus and minus zoom, F shows everything.";
