import { type Signal, useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { isolated } from "../core/isolation";
import { bytes } from "../result/format";
import { memory } from "./actions";
import * as state from "./state";

function Dialog({
  title,
  open,
  children,
}: {
  title: string;
  open: Signal<boolean>;
  children: ComponentChildren;
}) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  return (
    <dialog
      ref={dialog}
      aria-label={title}
      onClose={() => {
        open.value = false;
      }}
    >
      <div class="row">
        <h2>{title}</h2>
        <button type="button" onClick={() => dialog.current?.close()}>
          Close
        </button>
      </div>
      {children}
    </dialog>
  );
}

export function About() {
  const core = state.core.value;
  const held = useSignal<Awaited<ReturnType<typeof memory>>>(null);
  useEffect(() => {
    memory().then(
      (now) => {
        held.value = now;
      },
      () => {},
    );
  }, [held]);
  return (
    <Dialog title="About Vitruvian" open={state.aboutOpen}>
      <p>
        Registers a parametric human body to a 3D body scan. Everything is computed in this browser: no scan,
        picture or number leaves the computer, nothing is counted or reported. Once loaded it works without a
        network.
      </p>
      <p>
        <strong>Not a medical device.</strong> Do not base diagnosis or treatment on its results.
      </p>
      <dl>
        <dt>Version</dt>
        <dd>{core?.version ?? __VERSION__}</dd>
        <dt>Threads</dt>
        <dd>{core?.threads ?? (isolated() ? "available" : "not available here")}</dd>
        {held.value !== null && (
          <>
            <dt>Memory</dt>
            <dd>
              {bytes(held.value.heap)}, {bytes(held.value.inUse)} in use
            </dd>
          </>
        )}
      </dl>
      <h3>How to cite</h3>
      <p>
        The Vitruvian authors: Vitruvian, version {__VERSION__}, 2026. The method starts from: V. Chaurasia,
        J. Cueto Fernandez, J. M. Prendergast, E. van der Kruk: “BODIESReg: An open-source pipeline for
        registering 3D body scans using pose-aligned initialization”.{" "}
        <a href="./licences/CITATION.cff">CITATION.cff</a>
      </p>
      <h3>Licences</h3>
      <p>
        MIT: <a href="./licences/LICENSE.txt">LICENSE</a>. Third-party software, data and models, among them
        the BlazePose networks (Google, Apache-2.0), MakeHuman’s CC0 body and the CMU Motion Capture Database
        (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217):{" "}
        <a href="./licences/THIRD_PARTY.md">THIRD_PARTY</a>.
      </p>
    </Dialog>
  );
}

const KEYS: [string, string][] = [
  ["1 – 6", "go to a stage"],
  ["O", "open a scan"],
  ["S", "run the stage shown"],
  ["R", "register: run all stages that are left"],
  ["Esc", "cancel"],
  ["Arrow keys", "turn the view (when it has the focus)"],
  ["+ −", "zoom"],
  ["F", "show everything"],
  ["?", "this list"],
];

export function Help() {
  return (
    <Dialog title="Keys" open={state.helpOpen}>
      <dl class="keys">
        {KEYS.map(([key, what]) => (
          <>
            <dt>
              <kbd>{key}</kbd>
            </dt>
            <dd>{what}</dd>
          </>
        ))}
      </dl>
    </Dialog>
  );
}
