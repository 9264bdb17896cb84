// The user's own model files and what they made of the models. Only models/use.ts changes what is in use.
import { computed, signal } from "@preact/signals";
import type { CoreClient } from "../core/client";
import type { ModelKind, ModelsInfo } from "./types";

export interface OwnFile {
  file: Blob;
  name: string;
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

/** Whether a user's body takes the place of the bundled one. */
export const ownBody = computed(() => files.value.some(({ kind }) => kind === "body"));

/** A file that is a model by its name; scans have other endings. */
export function isModelFile(name: string): boolean {
  return /\.(pkl|npz|ckpt|pt|pth|vbm|vpp)$/i.test(name);
}

/** Gives the core a set of files; landmarks that were learnt before are given with them. @throws CoreError */
export async function send(
  client: CoreClient,
  chosen: readonly { file: Blob; name: string }[],
): Promise<ModelsInfo> {
  return client.call("models", {
    files: chosen.map(({ file, name }) => ({ file, name })),
    landmarks: info.peek()?.landmarks ?? null,
  });
}

/** Gives a new core the files in use. @throws CoreError */
export async function sendAgain(client: CoreClient): Promise<void> {
  if (files.peek().length > 0) info.value = await send(client, files.peek());
}
