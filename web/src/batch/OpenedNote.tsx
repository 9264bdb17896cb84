import { busy, result } from "../ui/state";
import * as queue from "./queue";
import { leave, putBack } from "./run";

/** Over the main view while a scan of the batch is open in it. */
export function OpenedNote() {
  const item = queue.itemOf(queue.opened.value);
  if (!item) return null;
  return (
    <section class="from-batch" aria-label="From the batch">
      <span>
        <strong>{item.folder}</strong> of the batch
      </span>
      <button
        type="button"
        class="main"
        disabled={busy.value !== null || !result.value}
        title="The batch takes this result in place of its own"
        onClick={() => void putBack()}
      >
        Put it back
      </button>
      <button
        type="button"
        disabled={busy.value !== null}
        onClick={leave}
        title="The batch keeps the result that it has"
      >
        Back without
      </button>
    </section>
  );
}
