// What the user can do with model files of their own.
import { batch } from "@preact/signals";
import { withCore } from "../ui/actions";
import * as keeping from "./keep";
import * as own from "./own";
import { type OwnFile, send } from "./own";
import { givesWay, kModelKinds, type ModelFile, type ModelKind } from "./types";

/** Uses model files, in place of those of their kinds. */
export async function addModels(files: readonly ModelFile[]): Promise<void> {
  await use(files, []);
}

/** Uses the bundled model of a kind again. */
export async function removeModel(kind: ModelKind): Promise<void> {
  await use([], [kind]);
}

/** Uses the bundled models again, and forgets those that were kept. */
export async function useBundled(): Promise<void> {
  await use([], kModelKinds);
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
      for (const [sha256, text] of found.learnt) own.learnt.set(sha256, text);
    });
  } catch {
    own.keepingFailed.value = "The model files kept on this computer are gone or damaged: open them again.";
    await keeping.forget().catch(() => {});
  }
}

/** The change of models under way: what is dropped meanwhile waits for it. */
let changing: Promise<void> = Promise.resolve();

function use(fresh: readonly ModelFile[], without: readonly ModelKind[]): Promise<void> {
  changing = changing.then(() => replace(fresh, without));
  return changing;
}

async function replace(fresh: readonly ModelFile[], without: readonly ModelKind[]): Promise<void> {
  const held = own.files.value.filter(({ kind }) => !givesWay(kind, without));
  await withCore("pose", async (client) => {
    const info = await send(client, fresh, held);
    const files = [
      ...held.filter(({ kind }) => !givesWay(kind, info.kinds)),
      ...fresh.map(({ file, name }, i): OwnFile => ({ file, name, kind: info.kinds[i]! })),
    ];
    batch(() => {
      own.files.value = files.sort((a, b) => kModelKinds.indexOf(a.kind) - kModelKinds.indexOf(b.kind));
      own.info.value = info.own ? info : null;
    });
    if (own.kept.value) await setKept(info.own);
  });
}
