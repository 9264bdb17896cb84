// The user's own model files and what they made of the models. Only models/use.ts changes what is in use.
import { batch, computed, signal } from "@preact/signals";
import type { CoreClient } from "../core/client";
import { CoreError } from "../core/types";
import type { ModelFile, ModelKind, ModelsInfo } from "./types";

export interface OwnFile extends ModelFile {
  kind: ModelKind;
}

/** The files in use, one of a kind at most. */
export const files = signal<readonly OwnFile[]>([]);
/** The models in use; null: the bundled ones. */
export const info = signal<ModelsInfo | null>(null);
/** Whether the files are kept on this computer for the next visit. */
export const kept = signal(false);
/** Why they could not be kept or found again, in plain words; empty when they could. */
export const keepingFailed = signal("");

/** Where landmarks lie on the user's body models, as the core told, by the files' sha256. */
export const learnt = new Map<string, string>();

/** Whether a user's body takes the place of the bundled one. */
export const ownBody = computed(() => files.value.some(({ kind }) => kind === "body"));

/** A file that is a model by its name; scans have other endings. */
export function isModelFile(name: string): boolean {
  return /\.(pkl|npz|ckpt|pt|pth|vbm|vpp)$/i.test(name);
}

export function asModels(chosen: readonly File[]): ModelFile[] {
  return chosen.map((file) => ({ file, name: file.name }));
}

/** Gives the core new files, and those in use that do not give way to them. @throws CoreError */
export async function send(
  client: CoreClient,
  fresh: readonly ModelFile[],
  held: readonly OwnFile[],
): Promise<ModelsInfo> {
  const made = await client.call("models", {
    fresh: fresh.map(({ file, name }) => ({ file, name })),
    held: held.map(({ file, name, kind }) => ({ file, name, kind })),
    learnt: Object.fromEntries(learnt),
  });
  if (made.landmarks) learnt.set(made.landmarks.sha256, made.landmarks.text);
  return made;
}

/** Gives a new core the files in use. When it cannot use them they are in use no more. @throws CoreError */
export async function sendAgain(client: CoreClient): Promise<void> {
  if (files.peek().length === 0) return;
  try {
    info.value = await send(client, [], files.peek());
  } catch (error) {
    if (error instanceof CoreError && error.code === "bad_model") {
      batch(() => {
        files.value = [];
        info.value = null;
      });
    }
    throw error;
  }
}
