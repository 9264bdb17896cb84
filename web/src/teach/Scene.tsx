import { effect, useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { save } from "../result/download";
import type { ViewOptions } from "../ui/state";
import { isDark } from "../ui/theme";
import { startViewer } from "../viewer/start";
import type { Viewer } from "../viewer/viewer";

export const PLAIN_VIEW: ViewOptions = {
  showScan: true,
  showBody: true,
  scanOpacity: 1,
  bodyOpacity: 1,
  wireframe: false,
  split: false,
  heatMap: false,
  showKeypoints: true,
  legendMaximum: null,
};

interface Props {
  label: string;
  /** Each an effect of its own: what it reads of signals draws it anew. */
  draws: readonly ((viewer: Viewer) => void)[];
  children?: ComponentChildren;
}

/** A 3D view of its own that draws what it is told. */
export function Scene({ label, draws, children }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const viewer = useSignal<Viewer | null>(null);
  const failed = useSignal("");
  useEffect(() => {
    let live = true;
    startViewer(canvas.current!).then(
      (started) => {
        if (live) viewer.value = started;
        else started.dispose();
      },
      (error: unknown) => {
        failed.value = error instanceof Error ? error.message : String(error);
      },
    );
    return () => {
      live = false;
      viewer.peek()?.dispose();
    };
  }, [viewer, failed]);
  const first = useRef(draws);
  useEffect(() => {
    const view = viewer.value;
    if (!view) return;
    const stops = [(each: Viewer) => each.setDark(isDark.value), ...first.current].map((draw) =>
      effect(() => draw(view)),
    );
    return () => {
      for (const stop of stops) stop();
    };
  }, [viewer.value]);
  return (
    <section class="view" aria-label={label}>
      <canvas
        ref={canvas}
        tabIndex={0}
        aria-label={`${label}. Arrow keys turn, plus and minus zoom, F shows everything.`}
        onKeyDown={(event) => {
          if (viewer.peek() && turnByKey(viewer.peek()!, event.key)) event.preventDefault();
        }}
      />
      {failed.value && (
        <p class="view-note" role="alert">
          The 3D view could not start ({failed.value}). Switch on hardware acceleration or WebGL to see it.
        </p>
      )}
      <div class="view-tools" role="toolbar" aria-label="View">
        {(["front", "left", "back"] as const).map((side) => (
          <button type="button" key={side} onClick={() => viewer.value?.look(side)}>
            {side[0]!.toUpperCase() + side.slice(1)}
          </button>
        ))}
        <button
          type="button"
          title="The view as it is, as a picture"
          onClick={() => void viewer.value?.picture().then((png) => save("view.png", png))}
        >
          PNG
        </button>
      </div>
      {children}
    </section>
  );
}

const TURN = Math.PI / 24;

function turnByKey(viewer: Viewer, key: string): boolean {
  const keys: Record<string, () => void> = {
    ArrowLeft: () => viewer.orbit(-TURN, 0),
    ArrowRight: () => viewer.orbit(TURN, 0),
    ArrowUp: () => viewer.orbit(0, TURN),
    ArrowDown: () => viewer.orbit(0, -TURN),
    "+": () => viewer.zoom(1.15),
    "-": () => viewer.zoom(1 / 1.15),
    f: () => viewer.fit(),
  };
  keys[key]?.();
  return key in keys;
}
