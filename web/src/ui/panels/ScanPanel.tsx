import { bytes, integer } from "../../result/format";
import { openSample } from "../actions";
import { RegisterAll } from "../RunStage";
import { core, busy as isBusy, scan } from "../state";

export function ScanPanel({ pick }: { pick: () => void }) {
  const busy = isBusy.value !== null;
  const opened = scan.value;
  return (
    <>
      <div class={opened ? "open-scan" : "open-scan large"}>
        {!opened && <p>Drop a body scan anywhere on this page.</p>}
        <div class="buttons">
          <button type="button" class={opened ? "" : "main"} disabled={busy} onClick={pick}>
            Open a scan… <kbd>O</kbd>
          </button>
          <button type="button" disabled={busy} onClick={() => void openSample()}>
            Sample scan
          </button>
        </div>
        <p class="quiet">PLY, OBJ, STL, OFF, GLB, XYZ, PCD; also gzipped. It stays on this computer.</p>
      </div>
      {opened && (
        <>
          <dl>
            <dt>File</dt>
            <dd>{opened.file}</dd>
            <dt>Size</dt>
            <dd>{bytes(opened.bytes)}</dd>
            <dt>Vertices</dt>
            <dd>{integer(opened.vertices)}</dd>
            <dt>Faces</dt>
            <dd>{opened.faces === 0 ? "none: a point cloud" : integer(opened.faces)}</dd>
          </dl>
          {opened.notes.map((note) => (
            <p class="note" key={note}>
              {note}
            </p>
          ))}
          {opened.decimated && (
            <p class="note">The view shows a thinned copy; all points are used for the registration.</p>
          )}
          <RegisterAll main />
        </>
      )}
      {core.value?.threads === 1 && (
        <p class="note">
          This browser or site does not allow threads here: everything works, about as many times slower as
          the computer has cores.
        </p>
      )}
    </>
  );
}
