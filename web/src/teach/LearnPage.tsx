import { useEffect } from "preact/hooks";
import { explain } from "../core/explain";
import { seconds } from "../result/format";
import { cancel, openSample } from "../ui/actions";
import * as page from "../ui/state";
import { useNow } from "../ui/useNow";
import { CHAPTERS } from "./chapters";
import * as lesson from "./lesson";
import { body } from "./posing";
import { PLAIN_VIEW, Scene } from "./Scene";
import "./teach.css";

const NO_PAIRS = new Float32Array();
const FRAME_MS = 140;

/** The method, chapter by chapter, on the opened scan. */
export function LearnPage() {
  const { Panel } = CHAPTERS[lesson.chapter.value];
  return (
    <main class="learn">
      <nav class="chapters" aria-label="Chapters">
        {lesson.kChapters.map((name, i) => (
          <button
            type="button"
            key={name}
            aria-current={lesson.chapter.value === name ? "step" : undefined}
            onClick={() => lesson.open(name)}
          >
            {i + 1}. {CHAPTERS[name].title}
          </button>
        ))}
      </nav>
      <Scene
        label="What the chapter is about"
        draws={[
          (viewer) => viewer.setScan(page.scan.value),
          (viewer) => {
            viewer.setBodyFromScan(page.scan.value && (page.found.value.align?.body_from_scan ?? null));
            viewer.fit();
          },
          (viewer) => viewer.setAxes(lesson.chapter.value === "align" && page.found.value.align !== null),
          (viewer) => {
            const seen = lesson.chapter.value === "see" ? page.found.value.keypoints : null;
            viewer.setKeypoints(seen?.joints ?? []);
          },
          (viewer) => {
            const [positions, faces] = [lesson.filmBody.value, body.value?.faces];
            if (positions && faces) viewer.moveBody({ positions, indices: faces });
          },
          (viewer) => viewer.setSkeleton(triples(lesson.step.value?.joints)),
          (viewer) => {
            const step = lesson.step.value;
            const shown = lesson.chapter.value === "fit" && lesson.showPairs.value && step !== null;
            viewer.setPairs(shown ? step.pairs : NO_PAIRS, shown ? step.pairs_of_model : 0);
          },
          (viewer) => {
            const withBody = lesson.film.value.length > 0 && lesson.filmBody.value !== null;
            viewer.setOptions(
              { ...PLAIN_VIEW, showBody: withBody, scanOpacity: withBody ? 0.35 : 1, bodyOpacity: 0.6 },
              20,
            );
          },
        ]}
      >
        {lesson.film.value.length > 1 && lesson.chapter.value !== "judge" && <Film />}
      </Scene>
      <aside aria-label={CHAPTERS[lesson.chapter.value].title}>
        <h2>{CHAPTERS[lesson.chapter.value].title}</h2>
        <Working />
        {page.scan.value ? <Panel /> : <NoScan />}
      </aside>
    </main>
  );
}

function triples(numbers: Float32Array | undefined): [number, number, number][] {
  if (!numbers) return [];
  return Array.from({ length: numbers.length / 3 }, (_, i) => [
    numbers[3 * i]!,
    numbers[3 * i + 1]!,
    numbers[3 * i + 2]!,
  ]);
}

function NoScan() {
  return (
    <>
      <p>Every chapter shows its part of the method on a scan of yours, or on the sample.</p>
      <div class="buttons">
        <button
          type="button"
          class="main"
          disabled={page.busy.value !== null}
          onClick={() => void openSample()}
        >
          Sample scan
        </button>
      </div>
      <p class="quiet">Or drop a scan anywhere on this page.</p>
    </>
  );
}

function Working() {
  const { busy } = page;
  const now = useNow(busy.value !== null);
  const problem = lesson.problem.value ?? page.problem.value?.error;
  if (busy.value) {
    return (
      <div class="progress">
        <div class="row">
          <span>{page.doing.value}</span>
          <span class="quiet">{seconds(Math.max(now - busy.value.since, 0))}</span>
        </div>
        <progress
          aria-label={page.doing.value ?? ""}
          max={1}
          value={page.progress.value?.fraction ?? undefined}
        />
        <button type="button" onClick={cancel}>
          Cancel
        </button>
      </div>
    );
  }
  if (!problem) return null;
  const { what, mend } = explain(problem);
  return (
    <div class="problem" role="alert">
      <strong>{what}</strong> {mend}
      <p class="detail">{problem.message}</p>
    </div>
  );
}

/** The iterations, to be scrubbed and played. */
function Film() {
  const last = lesson.film.value.length - 1;
  const playing = lesson.playing.value;
  useEffect(() => {
    if (!playing) return;
    const timer = setInterval(() => {
      if (lesson.at.value >= last) lesson.playing.value = false;
      else lesson.at.value += 1;
    }, FRAME_MS);
    return () => clearInterval(timer);
  }, [playing, last]);
  return (
    <div class="film">
      <button
        type="button"
        onClick={() => {
          if (!playing && lesson.at.value >= last) lesson.at.value = 0;
          lesson.playing.value = !playing;
        }}
      >
        {playing ? "Pause" : "Play"}
      </button>
      <input
        type="range"
        aria-label="Iteration"
        min={0}
        max={last}
        value={Math.min(lesson.at.value, last)}
        onInput={(event) => {
          lesson.playing.value = false;
          lesson.at.value = Number(event.currentTarget.value);
        }}
      />
      <span>
        {Math.min(lesson.at.value, last)} / {last}
      </span>
      {lesson.chapter.value === "fit" && (
        <div class="checks">
          <label class="check">
            <input
              type="checkbox"
              checked={lesson.showPairs.value}
              onChange={(event) => {
                lesson.showPairs.value = event.currentTarget.checked;
              }}
            />
            Matched points: red from the body, blue from the scan
          </label>
        </div>
      )}
    </div>
  );
}
