import { useSignal } from "@preact/signals";
import type { SurfaceError } from "../../core/types";
import { displayName, millimetres, percent } from "../../result/format";
import { download, downloadAll } from "../actions";
import { Choice } from "../Choice";
import { ErrorHistogram } from "../ErrorHistogram";
import { half } from "../measuring";
import { RegisterAll } from "../RunStage";
import { type Measure, result, scan, stale } from "../state";
import { ViewControls } from "../ViewControls";
import { MeasurementsPanel } from "./MeasurementsPanel";

const VERDICTS = {
  ok: "The registration can be trusted.",
  doubtful: "Look at the result before you use it.",
  failed: "The body was not found in this scan.",
};

export function ResultsPanel() {
  const data = result.value;
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  if (!data) {
    return (
      <>
        {stale.value.has("register") && (
          <p class="note">A change has made the result out of date. Register again to see the new one.</p>
        )}
        <RegisterAll main />
      </>
    );
  }
  const { verdict } = data.registration;
  return (
    <>
      <div class={`verdict ${verdict.status}`}>
        <strong>{verdict.status === "ok" ? "OK" : displayName(verdict.status)}</strong>
        <span class="quiet"> confidence {percent(verdict.confidence)}</span>
        <p>{VERDICTS[verdict.status]}</p>
        {verdict.reasons.length > 0 && (
          <ul>
            {verdict.reasons.map((reason) => (
              <li key={reason}>{reason}</li>
            ))}
          </ul>
        )}
      </div>
      {verdict.status !== "failed" && (
        <Choice
          label="Show"
          value={half.value}
          options={HALVES}
          onChange={(value) => {
            half.value = value;
          }}
        />
      )}
      {verdict.status !== "failed" && half.value === "measurements" ? <MeasurementsPanel /> : <Distances />}
    </>
  );
}

const HALVES: [typeof half.value, string][] = [
  ["distances", "Distances"],
  ["measurements", "Measurements"],
];

function Distances() {
  const data = result.value!;
  const { verdict, surface_error, joints } = data.registration;
  return (
    <>
      <ViewControls />
      {surface_error && <Errors error={surface_error} />}
      {surface_error?.parametric && (
        <p class="quiet">
          Before the vertex offsets the mean was {millimetres(surface_error.parametric.surface_all.mean_mm)}{" "}
          mm. The verdict is about the body without them.
        </p>
      )}
      {data.vertexErrorMm.length > 0 && <ErrorHistogram valuesMm={data.vertexErrorMm} />}
      <Downloads
        failed={verdict.status === "failed"}
        offsets={data.registration.parameters?.offsets !== undefined}
      />
      {joints.length > 0 && (
        <details>
          <summary>Joints (scan frame, scan units)</summary>
          <table>
            <tbody>
              {joints.map(({ name, scan: at }) => (
                <tr key={name}>
                  <th scope="row">{displayName(name)}</th>
                  {at.map((value, axis) => (
                    <td class="figure" key={"xyz"[axis]}>
                      {Number(value.toPrecision(5))}
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </details>
      )}
    </>
  );
}

const MEASURES: [Measure, string][] = [
  ["surface", "To the surface"],
  ["points", "To points (paper)"],
];

function Errors({ error }: { error: SurfaceError }) {
  const measure = useSignal<Measure>("surface");
  const surface = measure.value === "surface";
  const rows = surface ? error.surface_segments : error.segments;
  const all = surface ? error.surface_all : error.all;
  return (
    <section aria-label="Errors by segment">
      <Choice
        label="Distance"
        value={measure.value}
        options={MEASURES}
        onChange={(value) => {
          measure.value = value;
        }}
      />
      <div class="wide">
        <table class="errors">
          <caption>Distance from the body to the scan, mm</caption>
          <thead>
            <tr>
              <th scope="col">Segment</th>
              <th scope="col">Seen</th>
              <th scope="col">Mean</th>
              <th scope="col">SD</th>
              <th scope="col">Median</th>
              <th scope="col">95 %</th>
              <th scope="col">Max</th>
            </tr>
          </thead>
          <tbody>
            <tr class="all">
              <th scope="row">All</th>
              <td />
              <Figures of={all} />
            </tr>
            {rows.map((row) => (
              <tr key={row.segment}>
                <th scope="row">{displayName(row.segment)}</th>
                <td class="figure">{percent(row.observed)}</td>
                <Figures of={row} />
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function Figures({
  of,
}: {
  of: Pick<SurfaceError["all"], "mean_mm" | "std_mm" | "median_mm" | "p95_mm" | "max_mm">;
}) {
  return (
    <>
      {(["mean_mm", "std_mm", "median_mm", "p95_mm", "max_mm"] as const).map((key) => (
        <td class="figure" key={key}>
          {millimetres(of[key])}
        </td>
      ))}
    </>
  );
}

/** The registered mesh in each format that the command line writes. */
const MESHES = ["registered.ply", "registered.obj", "registered.glb"];

function Downloads({ failed, offsets }: { failed: boolean; offsets: boolean }) {
  const names = ["registration.json"];
  if (!failed) names.push("errors.csv", ...MESHES);
  if (offsets) names.push("offsets.npz");
  return (
    <section aria-label="Downloads">
      <h3>Downloads</h3>
      <div class="buttons">
        {names.map((name) => (
          <button type="button" key={name} onClick={() => void download(name)}>
            {name}
          </button>
        ))}
        <button type="button" class="main" onClick={() => void downloadAll()}>
          All as ZIP
        </button>
      </div>
    </section>
  );
}
