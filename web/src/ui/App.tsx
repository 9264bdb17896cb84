import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { droppedFiles, isPile } from "../batch/files";
import * as queue from "../batch/queue";
import { kCoreStages, kStages } from "../core/types";
import { tool as editorTool } from "../editor/state";
import { asModels, isModelFile } from "../models/own";
import { addModels, restore } from "../models/use";
import { cancel, openFile, register, run } from "./actions";
import { About, Help } from "./Dialogs";
import { Header } from "./Header";
import { Inspector } from "./Inspector";
import { lazyPart } from "./lazy";
import { mode } from "./mode";
import { StageRail } from "./StageRail";
import * as state from "./state";
import { ViewPane } from "./ViewPane";

const BatchPage = lazyPart(() => import("../batch/BatchPage").then((m) => m.BatchPage));
const LearnPage = lazyPart(() => import("../teach/LearnPage").then((m) => m.LearnPage));
const BodyPage = lazyPart(() => import("../teach/BodyPage").then((m) => m.BodyPage));
const OpenedNote = lazyPart(() => import("../batch/OpenedNote").then((m) => m.OpenedNote));

/** Elements that use letters and digits themselves. */
const TYPING = "select, textarea, dialog, input:not([type=radio], [type=checkbox], [type=range])";

export function App() {
  const picker = useRef<HTMLInputElement>(null);
  const dragged = useSignal(false);
  const pick = () => picker.current?.click();

  useEffect(() => void restore(), []);

  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "Escape") return state.busy.value ? cancel() : undefined;
      if ((event.target as HTMLElement).closest(TYPING)) return;
      if (event.key !== "?" && mode.value !== "scan") return;
      // The editor has its own keys, and a run would leave its edits out.
      if (editorTool.value) return;
      const stage = kStages[Number(event.key) - 1];
      if (stage) state.stage.value = stage;
      else if (event.key === "o") pick();
      else if (event.key === "r") void register();
      else if (event.key === "s") {
        const core = kCoreStages.find((name) => name === state.stage.value);
        if (!core) return;
        void run(core);
      } else if (event.key === "?") state.helpOpen.value = true;
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", onKeyDown);
    return () => removeEventListener("keydown", onKeyDown);
  }, []);

  useEffect(() => {
    let depth = 0;
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const onEnter = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      depth += 1;
      dragged.value = true;
    };
    const onLeave = () => {
      depth = Math.max(depth - 1, 0);
      if (depth === 0) dragged.value = false;
    };
    const onOver = (event: DragEvent) => {
      if (hasFiles(event)) event.preventDefault();
    };
    const onDrop = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      depth = 0;
      dragged.value = false;
      if (event.dataTransfer) void dropped(event.dataTransfer);
    };
    addEventListener("dragenter", onEnter);
    addEventListener("dragleave", onLeave);
    addEventListener("dragover", onOver);
    addEventListener("drop", onDrop);
    return () => {
      removeEventListener("dragenter", onEnter);
      removeEventListener("dragleave", onLeave);
      removeEventListener("dragover", onOver);
      removeEventListener("drop", onDrop);
    };
  }, [dragged]);

  return (
    <>
      <Header />
      {mode.value === "batch" && <BatchPage />}
      {mode.value === "learn" && <LearnPage />}
      {mode.value === "body" && <BodyPage />}
      {mode.value === "scan" && queue.opened.value !== null && <OpenedNote />}
      <main class={mode.value === "scan" ? "" : "hidden"}>
        <StageRail />
        <ViewPane />
        <Inspector pick={pick} />
      </main>
      <input
        ref={picker}
        class="hidden"
        type="file"
        aria-label="Scan file"
        tabIndex={-1}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) void open(file);
        }}
      />
      {dragged.value && <div class="drop-here">Drop scans anywhere</div>}
      <Announcer />
      {state.aboutOpen.value && <About />}
      {state.helpOpen.value && <Help />}
    </>
  );
}

/** A scan, or a model file of the user's. */
async function open(file: File): Promise<void> {
  if (isModelFile(file.name)) await useModels([file]);
  else await openFile(file, file.name);
}

/** Puts model files to use, where they are listed. */
async function useModels(files: File[]): Promise<void> {
  mode.value = "scan";
  state.stage.value = "pose";
  await addModels(asModels(files));
}

/** Model files are put to use; of the rest, one scan is opened, several, or a folder, make a batch. */
async function dropped(transfer: DataTransfer): Promise<void> {
  const pile = isPile(transfer);
  const files = await droppedFiles(transfer);
  const models = files.filter(({ name }) => isModelFile(name));
  const scans = files.filter(({ name }) => !isModelFile(name));
  const before = mode.value;
  if (models.length > 0) {
    await useModels(models);
    if (scans.length === 0 || state.problem.value) return;
  }
  if (before === "batch" || (pile && (models.length === 0 || scans.length > 1))) {
    mode.value = "batch";
    queue.add(scans);
  } else if (scans[0]) {
    mode.value = before === "body" ? "scan" : before;
    await openFile(scans[0], scans[0].name);
  }
}

/** Says progress and outcomes to screen readers. */
function Announcer() {
  const busy = state.busy.value;
  const verdict = state.result.value?.registration.verdict;
  const text = busy
    ? `Working: ${state.progress.value?.stage ?? busy.stage}`
    : verdict
      ? `Verdict: ${verdict.status}`
      : "";
  return (
    <p class="unseen" role="status">
      {text}
    </p>
  );
}
