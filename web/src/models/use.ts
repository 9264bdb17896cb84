// What the user can do with model files of their own.
import { batch } from "@preact/signals";
import { withCore } from "../ui/actions";
import * as keeping from "./keep";
import * as own from "./own";
import { type OwnFile, send } from "./own";

/** Uses a model file, in place of one of its kind. */
export async function addModel(file: Blob, name: string): Promise<void> {
  await use([...own.files.value, { file, name }]);
}

/** Uses the bundled models again, and forgets those that were kept. */
export async function useBundled(): Promise<void> {
  await use([]);
  if (own.files.value.length === 0) await setKept(false);
}

/** Keeps the files in use on this computer, or forgets them. */
export async function setKept(wanted: boolean): Promise<void> {
  try {
    await (wanted ? keeping.keep() : keeping.forget());
    own.kept.value = wanted;
    own.keepingFailed.value = "";
  } catch (error) {
    own.kept.value = keeping.wanted();
    own.keepingFailed.value = `The browser could not ${wanted ? "keep" : "forget"} the files: ${error}`;
  }
}

/** Takes up what was kept at an earlier visit; the core gets it when it starts. */
export async function restore(): Promise<void> {
  if (!keeping.wanted()) return;
  try {
    const found = await keeping.restored();
    batch(() => {
      own.files.value = found.files;
      own.info.value = found.info;
      own.kept.value = true;
    });
  } catch {
    own.keepingFailed.value = "The model files kept on this computer are gone or damaged: open them again.";
    await keeping.forget().catch(() => {});
  }
}

async function use(chosen: { file: Blob; name: string }[]): Promise<void> {
  await withCore("pose", async (client) => {
    const info = await send(client, chosen);
    const files = new Map<string, OwnFile>();
    chosen.forEach(({ file, name }, i) => {
      const kind = info.kinds[i]!;
      files.set(kind, { file, name, kind });
    });
    batch(() => {
      own.files.value = [...files.values()];
      own.info.value = info.own ? info : null;
    });
    if (own.kept.value && info.own) await setKept(true);
  });
}
