import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { tool as editorTool } from "../editor/state";
import { millimetres } from "../result/format";
import { startViewer } from "../viewer/start";
import type { Direction, Viewer } from "../viewer/viewer";
import { Legend } from "./Legend";
import { lazyPart } from "./lazy";
import * as measuring from "./measuring";
import * as state from "./state";
import { isDark } from "./theme";

/** three.js and what draws with it are loaded when the editor is opened first. */
const EditorPane = lazyPart(async () => (await import("../editor/EditorPane")).EditorPane);
const PaintPane = lazyPart(async () => (await import("../paint/PaintPane")).PaintPane);

const TURN = Math.PI / 24;
const SIDES: [Direction, string][] = [
  ["front", "Front"],
  ["left", "Left"],
  ["back", "Back"],
  ["right", "Right"],
  ["top", "Top"],
];

/** The 3D view with its toolbar and legend. three.js is loaded when the first scan is opened. */
export function ViewPane() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const viewer = useSignal<Viewer | null>(null);
  const failed = useSignal("");
  const hasScan = state.scan.value !== null;
  // While a scan is being read, and the page has nothing else to do, the graphics card can get ready.
  const wanted = hasScan || (state.busy.value !== null && state.core.value !== null);

  const begun = useRef(false);
  useEffect(() => {
    if (!wanted || begun.current) return;
    begun.current = true;
    startViewer(canvas.current!).then(
      (started) => {
        viewer.value = started;
      },
      (error: unknown) => {
        failed.value = error instanceof Error ? error.message : String(error);
      },
    );
  }, [wanted, viewer, failed]);
  useEffect(() => () => viewer.peek()?.dispose(), [viewer]);

  useSignalEffect(() => viewer.value?.setScan(state.scan.value));
  useSignalEffect(() => {
    const matrix = state.found.value.align?.body_from_scan ?? null;
    if (!viewer.value || !state.scan.value) return;
    viewer.value.setBodyFromScan(matrix);
    viewer.value.look("front");
  });
  useSignalEffect(() => {
    const body = measuring.shownBody.value;
    viewer.value?.setBody(body?.mesh ?? null, body?.errorsMm ?? null);
  });
  useSignalEffect(() => {
    const keypoints = state.stage.value === "keypoints" ? state.found.value.keypoints : null;
    viewer.value?.setKeypoints(keypoints?.joints ?? []);
  });
  useSignalEffect(() => {
    const pose = state.stage.value === "pose" ? state.found.value.pose : null;
    viewer.value?.setSkeleton(pose?.joints.map(({ body_m }) => body_m) ?? []);
  });
  useSignalEffect(() =>
    viewer.value?.setAxes(state.stage.value === "align" && state.found.value.align !== null),
  );
  useSignalEffect(() => viewer.value?.setOptions(measuring.shownView.value, state.legend.value));
  useSignalEffect(() => viewer.value?.setCurve(measuring.drawn.value?.course ?? []));
  useSignalEffect(() => viewer.value?.setDark(isDark.value));

  const onKeyDown = (event: KeyboardEvent) => {
    const view = viewer.peek();
    if (!view || event.ctrlKey || event.metaKey || event.altKey) return;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => view.orbit(-TURN, 0),
      ArrowRight: () => view.orbit(TURN, 0),
      ArrowUp: () => view.orbit(0, TURN),
      ArrowDown: () => view.orbit(0, -TURN),
      "+": () => view.zoom(1.15),
      "=": () => view.zoom(1.15),
      "-": () => view.zoom(1 / 1.15),
      f: () => view.fit(),
    };
    const action = keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  };

  const probe = useSignal("");
  const onPointerMove = (event: PointerEvent) => {
    const errorsMm = measuring.shownBody.value?.errorsMm;
    if (event.buttons !== 0) return;
    const vertex = errorsMm ? (viewer.peek()?.pickBody(event.offsetX, event.offsetY) ?? -1) : -1;
    const error = errorsMm?.[vertex];
    probe.value = error === undefined ? "" : `${millimetres(error)} mm from the scan here`;
  };

  return (
    <section class="view" aria-label="3D view">
      <canvas
        ref={canvas}
        tabIndex={0}
        aria-label="Scan and body. Arrow keys turn, plus and minus zoom, F shows everything."
        onKeyDown={onKeyDown}
        onPointerMove={onPointerMove}
      />
      {failed.value && (
        <p class="view-note" role="alert">
          The 3D view could not start ({failed.value}). Registration works without it; switch on hardware
          acceleration or WebGL to see it.
        </p>
      )}
      {hasScan && (
        <div class="view-tools" role="toolbar" aria-label="View">
          {SIDES.map(([direction, name]) => (
            <button type="button" key={direction} onClick={() => viewer.value?.look(direction)}>
              {name}
            </button>
          ))}
          <button type="button" onClick={() => viewer.value?.fit()} title="Show everything (F)">
            Fit
          </button>
        </div>
      )}
      {measuring.shownBody.value?.errorsMm && state.shownView.value.showBody && state.view.value.heatMap && (
        <Legend />
      )}
      {measuring.drawn.value && <p class="measured">{measuring.drawn.value.text}</p>}
      {probe.value && <p class="probe">{probe.value}</p>}
      <BusyNote />
      {editorTool.value && (editorTool.value === "paint" ? <PaintPane /> : <EditorPane />)}
    </section>
  );
}

function BusyNote() {
  if (!state.busy.value) return null;
  return (
    <p class="view-note busy" aria-hidden="true">
      {state.doing.value}…
    </p>
  );
}
