import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { save } from "../result/download";
import { archive } from "./archive";
import { scansAmong } from "./files";
import { ItemPanel } from "./ItemPanel";
import { ItemRow } from "./ItemRow";
import * as queue from "./queue";
import { pause, start } from "./run";
import { SettingsPanel } from "./SettingsPanel";
import { dropAll, restoreKept } from "./store";
import { batchCsv } from "./table";
import "./batch.css";

/** Many scans, registered one after the other. */
export function BatchPage() {
  useEffect(() => {
    void restoreKept();
  }, []);
  const selected = queue.itemOf(queue.selected.value);
  return (
    <main class="batch">
      <section class="queue" aria-label="Scans">
        <Tools />
        <Summary />
        {queue.items.value.length === 0 ? (
          <Empty />
        ) : (
          <ul class="scans">
            {queue.items.value.map((item) => (
              <ItemRow key={item.id} item={item} />
            ))}
          </ul>
        )}
      </section>
      {selected ? <ItemPanel item={selected} /> : <SettingsPanel />}
    </main>
  );
}

function Empty() {
  return (
    <div class="open-scan large">
      <p>Drop many scans, or a folder of them, anywhere on this page.</p>
      <p class="quiet">
        They are registered one after the other, here in the browser. A scan that cannot be read does not stop
        the others. At the end: one table, and one ZIP with a folder for each scan.
      </p>
    </div>
  );
}

function Tools() {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const packing = useSignal(false);
  const { left, all } = queue.counts.value;
  const running = queue.running.value;
  const done = queue.items.value.some(({ outcome }) => outcome);
  const waiting = queue.items.value.some(({ status, file }) => status === "waiting" && file);
  const take = (input: HTMLInputElement, among: (files: File[]) => File[]) => {
    queue.add(among([...(input.files ?? [])]));
    input.value = "";
  };
  return (
    <div class="buttons" role="toolbar" aria-label="Batch">
      <button type="button" class={all === 0 ? "main" : ""} onClick={() => files.current?.click()}>
        Add scans…
      </button>
      <button type="button" onClick={() => folder.current?.click()}>
        Add a folder…
      </button>
      {running ? (
        <button type="button" onClick={pause} title="The scan at work ends; no other is begun">
          Pause
        </button>
      ) : (
        <button type="button" class={waiting ? "main" : ""} disabled={!waiting} onClick={() => void start()}>
          {left > 0 && left < all ? "Go on" : "Start"}
        </button>
      )}
      <button
        type="button"
        disabled={!done || packing.value}
        title="A folder for each scan, with its measurements, as the command line writes it; and the tables"
        onClick={async () => {
          packing.value = true;
          const zip = await archive(queue.items.value);
          packing.value = false;
          save("batch.zip", zip);
        }}
      >
        {packing.value ? "Packing…" : "All results as ZIP"}
      </button>
      <button
        type="button"
        disabled={all === left}
        title="One row a scan"
        onClick={() => save("batch.csv", new Blob([batchCsv(queue.items.value)], { type: "text/csv" }))}
      >
        Table as CSV
      </button>
      <button
        type="button"
        disabled={all === 0 || running}
        title="Takes all scans off the list, and kept results with them"
        onClick={() => {
          queue.removeAll();
          void dropAll();
        }}
      >
        Remove all
      </button>
      <input
        ref={files}
        class="hidden"
        type="file"
        multiple
        aria-label="Scans for the batch"
        tabIndex={-1}
        onChange={(event) => take(event.currentTarget, (list) => list)}
      />
      <input
        ref={folder}
        class="hidden"
        type="file"
        // @ts-expect-error: not a standard attribute, but known to all browsers
        webkitdirectory=""
        aria-label="Folder for the batch"
        tabIndex={-1}
        onChange={(event) => take(event.currentTarget, scansAmong)}
      />
    </div>
  );
}

function Summary() {
  const { all, left, ok, doubtful, failed, errors } = queue.counts.value;
  if (all === 0) return null;
  const parts: [number, string][] = [
    [left, "to do"],
    [ok, "ok"],
    [doubtful, "doubtful"],
    [failed, "failed"],
    [errors, "not registered"],
  ];
  const text = parts.flatMap(([count, what]) => (count > 0 ? [`${count} ${what}`] : [])).join(", ");
  return (
    <p class="quiet" role="status">
      {all} {all === 1 ? "scan" : "scans"}: {text}
    </p>
  );
}
