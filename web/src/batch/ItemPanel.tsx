import { useEffect, useRef } from "preact/hooks";
import { explain } from "../core/explain";
import { save } from "../result/download";
import { millimetres, percent, seconds } from "../result/format";
import type { Item } from "./queue";
import * as queue from "./queue";
import { openInView } from "./run";
import { SettingsChoices } from "./SettingsPanel";
import { dropItem } from "./store";

/** All that is known about one scan, and what can be done with it. */
export function ItemPanel({ item }: { item: Item }) {
  const { id, folder, picture, outcome, error, status } = item;
  const working = status === "working";
  const panel = useRef<HTMLElement>(null);
  // On a narrow screen it lies below the list.
  useEffect(() => panel.current?.scrollIntoView({ block: "nearest" }), [id]);
  return (
    <aside ref={panel} aria-label={`Scan ${folder}`}>
      <div class="row">
        <h2>{folder}</h2>
        <button
          type="button"
          onClick={() => {
            queue.selected.value = null;
          }}
        >
          Close
        </button>
      </div>
      {picture && (
        <img
          class="large-picture"
          src={picture}
          alt={outcome ? "The body, coloured by its distance to the scan" : "The scan"}
        />
      )}
      {error && <Problem item={item} />}
      {outcome && <Result outcome={outcome} />}
      <div class="buttons">
        <button
          type="button"
          class="main"
          disabled={!item.file || working}
          title="See it in 3D, mend it, and put it back here"
          onClick={() => void openInView(id)}
        >
          Open
        </button>
        <button
          type="button"
          disabled={!item.file || working || status === "waiting"}
          title="Puts the scan back into the queue"
          onClick={() => queue.again(id)}
        >
          Run again
        </button>
        {outcome && (
          <button type="button" onClick={() => save(`${folder}.zip`, outcome.files)}>
            Result as ZIP
          </button>
        )}
        <button
          type="button"
          disabled={working}
          onClick={() => {
            queue.remove(id);
            void dropItem(folder);
          }}
        >
          Remove
        </button>
      </div>
      {!item.file && (
        <p class="note">
          The result was kept from an earlier visit; the scan was not. Add the same file again to open or
          repeat it.
        </p>
      )}
      {outcome?.start && (
        <label class="check">
          <input
            type="checkbox"
            checked={queue.startFrom.value === id}
            onChange={(event) => {
              queue.startFrom.value = event.currentTarget.checked ? id : null;
            }}
          />
          Start all other scans from this body: for one person in one pose, scanned many times
        </label>
      )}
      <h3>Settings</h3>
      <label class="check">
        <input
          type="checkbox"
          checked={item.settings !== null}
          disabled={working}
          onChange={(event) =>
            queue.update(id, { settings: event.currentTarget.checked ? queue.settingsForAll.value : null })
          }
        />
        Other settings for this scan than for all
      </label>
      {item.settings && (
        <SettingsChoices
          settings={item.settings}
          disabled={working}
          onChange={(settings) => queue.update(id, { settings })}
        />
      )}
      {item.settings && status === "done" && <p class="quiet">They count when the scan is run again.</p>}
    </aside>
  );
}

function Problem({ item }: { item: Item }) {
  if (!item.error) return null;
  const { what, mend, detail } = explain(item.error);
  return (
    <div class="problem" role="alert">
      <strong>{what}</strong> {mend}
      <p class="detail">{detail}</p>
    </div>
  );
}

function Result({ outcome: { verdict, ...outcome } }: { outcome: queue.Outcome }) {
  return (
    <div class={`verdict ${verdict.status}`}>
      <strong>{verdict.status === "ok" ? "OK" : verdict.status}</strong>
      <span class="quiet"> confidence {percent(verdict.confidence)}</span>
      {verdict.reasons.length > 0 && (
        <ul>
          {verdict.reasons.map((reason) => (
            <li key={reason}>{reason}</li>
          ))}
        </ul>
      )}
      <dl>
        <dt>Body to scan, mean</dt>
        <dd>{millimetres(outcome.mean_mm)} mm</dd>
        <dt>Body to scan, 95 %</dt>
        <dd>{millimetres(outcome.p95_mm)} mm</dd>
        <dt>Scan to body, 95 %</dt>
        <dd>{millimetres(outcome.scan_p95_mm)} mm</dd>
        <dt>Time</dt>
        <dd>{seconds(1000 * outcome.seconds)}</dd>
      </dl>
    </div>
  );
}
