import { Fragment } from "preact";
import { useRef } from "preact/hooks";
import * as own from "../models/own";
import { asModels } from "../models/own";
import type { ModelKind } from "../models/types";
import { addModels, removeModel, setKept, useBundled } from "../models/use";
import { bytes, integer } from "../result/format";
import { busy } from "./state";
import "./inputs.css";

const KINDS: Record<ModelKind, string> = {
  body: "Body file",
  "soft tissue": "Soft tissue",
  prior: "Pose prior",
};

/** The user's own model files: what is in use, and how to bring, keep and leave them. */
export function OwnModels() {
  const picker = useRef<HTMLInputElement>(null);
  const info = own.info.value;
  const working = busy.value !== null;
  return (
    <section aria-label="Own model files" class="own-models">
      {info && (
        <dl>
          <dt>Body model</dt>
          <dd>
            {info.name} ({info.family}): {integer(info.vertices)} vertices, {info.joints} joints, {info.betas}{" "}
            shape components
          </dd>
          {own.files.value.map(({ kind, name, file }) => (
            <Fragment key={kind}>
              <dt>{KINDS[kind]}</dt>
              <dd>
                {name}, {bytes(file.size)}{" "}
                <button
                  type="button"
                  disabled={working}
                  aria-label={`Remove ${name}`}
                  onClick={() => void removeModel(kind)}
                >
                  Remove
                </button>
              </dd>
            </Fragment>
          ))}
        </dl>
      )}
      <div class="buttons">
        <button type="button" disabled={working} onClick={() => picker.current?.click()}>
          Own model…
        </button>
        {info && (
          <button type="button" disabled={working} onClick={() => void useBundled()}>
            Bundled model again
          </button>
        )}
      </div>
      <input
        ref={picker}
        class="hidden"
        type="file"
        multiple
        accept=".pkl,.npz,.ckpt,.pt,.pth,.vbm,.vpp"
        aria-label="Model file"
        tabIndex={-1}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length > 0) void addModels(asModels(files));
        }}
      />
      {info ? (
        <label class="check">
          <input
            type="checkbox"
            checked={own.kept.value}
            onChange={(event) => void setKept(event.currentTarget.checked)}
          />
          {own.kept.value
            ? "Kept in this browser for the next visit"
            : "Keep in this browser for the next visit"}
        </label>
      ) : (
        <p class="quiet">
          SMPL, SMPL+H, SMPL-X or STAR (.pkl, .npz), DMPL (.npz), VPoser (.ckpt): drop them on the page,
          together those that belong together. They stay on this computer.
        </p>
      )}
      {own.keepingFailed.value && (
        <p class="note" role="alert">
          {own.keepingFailed.value}
        </p>
      )}
    </section>
  );
}
