import { explain } from "../core/explain";
import { bytes, millimetres, percent, seconds } from "../result/format";
import { cancel } from "../ui/actions";
import { doing, progress } from "../ui/state";
import type { Item } from "./queue";
import * as queue from "./queue";

/** One scan of the batch, in a line. Its name opens what is known about it. */
export function ItemRow({ item }: { item: Item }) {
  const { id, folder, name, picture, outcome } = item;
  const isSelected = queue.selected.value === id;
  return (
    <li class={isSelected ? "scan-row selected" : "scan-row"}>
      <div class="picture">{picture && <img src={picture} alt="" />}</div>
      <div class="what">
        <button
          type="button"
          class="name"
          aria-expanded={isSelected}
          title="Details and settings of this scan"
          onClick={() => {
            queue.selected.value = isSelected ? null : id;
          }}
        >
          {folder}
        </button>
        <span class="quiet">
          {name}, {bytes(item.bytes)}
          {item.settings && ", own settings"}
          {queue.startFrom.value === id && ", start for the rest"}
        </span>
      </div>
      <Status item={item} />
      {outcome && (
        <dl class="numbers">
          <dt>Mean</dt>
          <dd>{millimetres(outcome.mean_mm)} mm</dd>
          <dt>95 %</dt>
          <dd>{millimetres(outcome.p95_mm)} mm</dd>
          <dt>Time</dt>
          <dd>{seconds(1000 * outcome.seconds)}</dd>
        </dl>
      )}
    </li>
  );
}

function Status({ item: { status, outcome, error, file } }: { item: Item }) {
  if (status === "working") {
    return (
      <div class="status">
        <span>{doing.value ?? "Preparing"}</span>
        <progress max={1} value={progress.value?.fraction ?? undefined} aria-label={doing.value ?? ""} />
        <button type="button" onClick={cancel}>
          Stop
        </button>
      </div>
    );
  }
  if (error) {
    const { what } = explain(error);
    return (
      <div class="status">
        <span class="mark failed">Not registered</span>
        <span class="quiet">{what}</span>
      </div>
    );
  }
  if (!outcome) {
    return (
      <div class="status">
        <span class="mark">{file ? "Waiting" : "Add the file again"}</span>
      </div>
    );
  }
  const { verdict } = outcome;
  return (
    <div class="status">
      <span class={`mark ${verdict.status}`}>
        {verdict.status === "ok" ? "OK" : verdict.status === "doubtful" ? "Doubtful" : "Failed"}
      </span>
      <span class="quiet">{verdict.reasons[0] ?? `confidence ${percent(verdict.confidence)}`}</span>
    </div>
  );
}
