// What each chapter says, shows and lets play with. The numbers are the core's.
import type { ComponentChildren, ComponentType } from "preact";
import type { EnergyTerm } from "../core/teaching";
import { histogram } from "../result/histogram";
import { Choice } from "../ui/Choice";
import { viewCount } from "../ui/MethodChoice";
import { ViewPicture } from "../ui/panels/KeypointsPanel";
import * as page from "../ui/state";
import * as formulas from "./formulas";
import * as lesson from "./lesson";
import { Plot, type Series } from "./Plot";

const TERMS: [EnergyTerm, string, string][] = [
  ["model_to_scan", "body to scan", "#c2185b"],
  ["scan_to_model", "scan to body", "#1b7fbd"],
  ["landmarks", "keypoints", "#8a5fbf"],
  ["pose_prior", "pose prior", "#2e8b57"],
  ["joint_limits", "joint limits", "#b8860b"],
  ["shape_prior", "shape prior", "#d2691e"],
];

function Section({ paper, children }: { paper: string; children: ComponentChildren }) {
  return (
    <>
      {children}
      <p class="quiet">In the paper: section {paper}.</p>
    </>
  );
}

/** Runs the lesson when its chapter is opened without one. */
function Run({ label }: { label: string }) {
  return (
    <div class="buttons">
      <button
        type="button"
        class={lesson.lesson.value ? "" : "main"}
        disabled={page.busy.value !== null}
        onClick={() => void lesson.runLesson()}
      >
        {lesson.lesson.value ? "Run again" : label}
      </button>
    </div>
  );
}

function Consequence() {
  const data = lesson.lesson.value;
  if (!data) return null;
  const { largest, mean } = data.apart_mm;
  return (
    <p class="note" role="status">
      {largest === 0
        ? "Nothing is changed: this is how the registration starts."
        : `At the end of the fit the joints lie ${mean.toFixed(1)} mm from those of the unchanged fit on average, ${largest.toFixed(1)} mm at most.`}
    </p>
  );
}

function Align() {
  const { align } = page.found.value;
  return (
    <>
      <Section paper="3.1.1">
        <p>
          A file has axes and units of its own. First it is stood up: one rotation R, the centroid c, and the
          factor s to metres take every point p of the scan into the body’s frame.
        </p>
        <formulas.Placement />
        <p>
          The paper takes R from the main directions of the points (PCA). Sitting or reaching bodies break
          that; here pictures from six sides tell what is up, and what is seen in them tells what is front.
        </p>
      </Section>
      <Choice
        label="Play: what is up"
        value={page.settings.value.up}
        options={[
          ["auto", "Found"],
          ["x", "+X"],
          ["y", "+Y"],
          ["z", "+Z"],
        ]}
        disabled={page.busy.value !== null}
        onChange={(up) => void lesson.playStage({ up }, "align")}
      />
      {!align && (
        <div class="buttons">
          <button
            type="button"
            class="main"
            disabled={page.busy.value !== null}
            onClick={() => void lesson.playStage({}, "align")}
          >
            Stand it up
          </button>
        </div>
      )}
      {align && (
        <p class="note" role="status">
          Up is {align.up}, front is {align.front}, the unit is {align.unit}: {align.height_m.toFixed(2)} m
          tall.
        </p>
      )}
    </>
  );
}

function See() {
  const { keypoints } = page.found.value;
  const views = String(viewCount(page.settings.value)) as "2" | "8";
  const seen = keypoints?.joints.filter(({ source }) => source !== "none") ?? [];
  const sure = seen.reduce((sum, { confidence }) => sum + confidence, 0) / Math.max(seen.length, 1);
  return (
    <>
      <Section paper="3.1.2 and 3.1.3, appendices A and B">
        <p>
          The scan is drawn from several sides, and a network made for photographs finds 33 landmarks in each
          picture. A landmark x in space is where the lines of sight from all pictures meet best, each picture
          i counting with its confidence <formulas.Named of="w" at="i" />:
        </p>
        <formulas.Triangulation />
        <p>ρ lets single wrong sightings count little. Two views leave nothing to outvote them.</p>
      </Section>
      <Choice
        label="Play: pictures"
        value={views}
        options={[
          ["8", "8, all round"],
          ["2", "2, as published"],
        ]}
        disabled={page.busy.value !== null}
        onChange={(value) => void lesson.playStage({ views: value === "8" ? 8 : 2 }, "keypoints")}
      />
      {!keypoints && (
        <div class="buttons">
          <button
            type="button"
            class="main"
            disabled={page.busy.value !== null}
            onClick={() => void lesson.playStage({}, "keypoints")}
          >
            Look at it
          </button>
        </div>
      )}
      {keypoints && (
        <>
          <p class="note" role="status">
            {seen.length} of 22 joints, confidence {Math.round(100 * sure)} % on average, from{" "}
            {keypoints.views.length} pictures.
          </p>
          <div class="views">
            {keypoints.views.map((view, i) => (
              <ViewPicture key={i} data={view} label={`View ${i + 1} with landmarks`} />
            ))}
          </div>
        </>
      )}
    </>
  );
}

function Pose() {
  const { keypoint_noise_mm } = lesson.settings.value;
  const film = lesson.film.value;
  return (
    <>
      <Section paper="3.1.4">
        <p>
          Which pose puts the body’s own landmarks <formulas.Named of="l" at="k" /> where they were seen, and
          is one that people take? The second term is small for poses like those of recorded people, the third
          for usual shapes.
        </p>
        <formulas.LandmarkEnergy />
      </Section>
      <label class="slider with-figure">
        <span>Play: keypoint noise</span>
        <input
          type="range"
          min={0}
          max={200}
          step={10}
          value={keypoint_noise_mm}
          disabled={page.busy.value !== null}
          aria-label="Keypoint noise, mm"
          onChange={(event) => lesson.play({ keypoint_noise_mm: Number(event.currentTarget.value) })}
        />
        <span class="figure">{keypoint_noise_mm} mm</span>
      </label>
      <Run label="Pose the body" />
      <Consequence />
      {film.length > 0 && (
        <>
          <Energy names={["landmarks", "pose_prior", "joint_limits", "shape_prior"]} />
          <Plot
            title="Keypoints from their places, mm"
            series={[{ name: "weighted mean", colour: "#8a5fbf", values: film.map((s) => s.landmark_mm) }]}
            range={["first iteration", "last"]}
            marked={lesson.at.value}
            onPick={pick}
          />
        </>
      )}
      {lesson.lesson.value && film.length === 0 && (
        <p class="note">
          The T-pose start of the next chapter uses no keypoints: there is nothing to see here.
        </p>
      )}
    </>
  );
}

function pick(index: number): void {
  lesson.playing.value = false;
  lesson.at.value = index;
}

function Energy({ names }: { names: readonly EnergyTerm[] }) {
  const series: Series[] = TERMS.filter(([term]) => names.includes(term)).map(([term, name, colour]) => ({
    name,
    colour,
    values: lesson.film.value.map(({ energy }) => energy[term]),
  }));
  return (
    <Plot
      title="Energy by term, logarithmic"
      series={series}
      range={["first iteration", "last"]}
      logarithmic
      marked={lesson.at.value}
      onPick={pick}
    />
  );
}

function Fit() {
  const { tpose, one_directional, prior_weight, iterations } = lesson.settings.value;
  const film = lesson.film.value;
  const busy = page.busy.value !== null;
  return (
    <>
      <Section paper="3.2">
        <p>
          Pose and shape now follow the surface. Each body point v is drawn to the nearest scan point s, and
          each scan point to the nearest body point, along the surface’s normal n; far pairs count little, and
          less and less far ones count at all.
        </p>
        <formulas.SurfaceEnergy />
        <p class="quiet">
          This is one start of the fit. A registration also looks for misplaced limbs, tries other starts, and
          refines.
        </p>
      </Section>
      <Choice
        label="Play: start"
        value={tpose ? "tpose" : "pose"}
        options={[
          ["pose", "From the keypoints"],
          ["tpose", "T-pose"],
        ]}
        disabled={busy}
        onChange={(value) => lesson.play({ tpose: value === "tpose" })}
      />
      <Choice
        label="Play: distances"
        value={one_directional ? "one" : "both"}
        options={[
          ["both", "Both ways"],
          ["one", "Only body to scan"],
        ]}
        disabled={busy}
        onChange={(value) => lesson.play({ one_directional: value === "one" })}
      />
      <Choice
        label="Play: weight of the priors"
        value={String(prior_weight)}
        options={[
          ["0", "None"],
          ["1", "As ever"],
          ["10", "10 ×"],
          ["100", "100 ×"],
        ]}
        disabled={busy}
        onChange={(value) => lesson.play({ prior_weight: Number(value) })}
      />
      <label class="slider with-figure">
        <span>Play: stop after</span>
        <input
          type="range"
          min={1}
          max={36}
          value={iterations}
          disabled={busy}
          aria-label="Iterations"
          onChange={(event) => lesson.play({ iterations: Number(event.currentTarget.value) })}
        />
        <span class="figure">{iterations}</span>
      </label>
      <Run label="Fit" />
      <Consequence />
      {film.length > 0 && (
        <>
          <Energy names={TERMS.map(([term]) => term)} />
          <Plot
            title="Median distance along the normal, mm"
            series={[
              { name: "body to scan", colour: "#c2185b", values: film.map((s) => s.model_to_scan_mm) },
              { name: "scan to body", colour: "#1b7fbd", values: film.map((s) => s.scan_to_model_mm) },
            ]}
            range={["first iteration", "last"]}
            logarithmic
            marked={lesson.at.value}
            onPick={pick}
          />
        </>
      )}
    </>
  );
}

const BINS = 40;
const HISTOGRAM_MM = 40;

function Judge() {
  const data = lesson.lesson.value;
  const counts = (metres: Float32Array) =>
    histogram(
      metres.map((value) => 1000 * value),
      HISTOGRAM_MM,
      BINS,
    ).counts;
  return (
    <>
      <Section paper="3.3 and appendix D">
        <p>
          What is left is the distance of each of the body’s vertices to the scan. A right fit has one narrow
          hill near zero; a limb in the wrong place is a long tail, which a mean hides.
        </p>
        <formulas.Residual />
        <p>
          The verdict of a registration rests on such residuals both ways, by body part, with coverage, joint
          limits and agreement with the keypoints.
        </p>
      </Section>
      <Run label="Fit" />
      <Consequence />
      {data && (
        <Plot
          title="Vertices by distance to the scan"
          series={[
            { name: "unchanged fit", colour: "#7d8890", values: counts(data.unchanged_residual_m) },
            { name: "with what is changed", colour: "#d2691e", values: counts(data.residual_m) },
          ]}
          range={["0 mm", `${HISTOGRAM_MM} mm and more`]}
        />
      )}
    </>
  );
}

export const CHAPTERS: Record<lesson.Chapter, { title: string; Panel: ComponentType }> = {
  align: { title: "Stand it up", Panel: Align },
  see: { title: "Look at it", Panel: See },
  pose: { title: "Pose a body", Panel: Pose },
  fit: { title: "Fit it", Panel: Fit },
  judge: { title: "Judge", Panel: Judge },
};
