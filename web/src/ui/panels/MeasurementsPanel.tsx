import { useSignal } from "@preact/signals";
import { type Dimension, EXPORTS, type Figure } from "../../core/measurements";
import { displayName } from "../../result/format";
import { Choice } from "../Choice";
import * as measuring from "../measuring";
import { Profile } from "../ProfilePlot";

const FIGURES: [Figure, string][] = [
  ["standing", "Standing"],
  ["sitting", "Sitting"],
  ["scanned", "As scanned"],
];

const WORDS: Record<Figure, string> = {
  standing: "Re-posed to stand upright, arms 20 degrees from the vertical, as the standards want.",
  sitting: "Re-posed to sit upright, thighs level, lower legs vertical. No chair presses the flesh.",
  scanned:
    "In the pose of the scan: tapes and lines over the same points of the skin. Heights have no meaning here.",
};

const GROUPS: [Dimension["kind"], string][] = [
  ["tape", "Girths and arcs"],
  ["height", "Heights"],
  ["line", "Lengths and breadths"],
  ["extent", "Extents"],
];

/** Everything that was measured on the registered body. */
export function MeasurementsPanel() {
  const data = measuring.measurements.value;
  const wanted = useSignal("");
  if (measuring.trouble.value) {
    return (
      <p class="problem" role="alert">
        The body could not be measured: {measuring.trouble.value}
      </p>
    );
  }
  if (!data) return <p class="quiet">Measuring…</p>;
  const words = wanted.value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = measuring.dimensions.value.filter((each) =>
    words.every((word) => measuring.title(each).toLowerCase().includes(word)),
  );
  return (
    <>
      <Choice
        label="Body"
        value={measuring.figure.value}
        options={FIGURES}
        onChange={(value) => {
          measuring.figure.value = value;
        }}
      />
      <p class="quiet">{WORDS[measuring.figure.value]}</p>
      <label class="row">
        Find
        <input
          type="search"
          value={wanted.value}
          placeholder="girth, left…"
          onInput={(event) => {
            wanted.value = event.currentTarget.value;
          }}
        />
      </label>
      <div class="measurements">
        {GROUPS.map(([kind, name]) => (
          <Group key={kind} name={name} rows={rows.filter((each) => each.kind === kind)} />
        ))}
        {rows.length === 0 && <p class="quiet">No dimension has these words in its name.</p>}
      </div>
      <Profile />
      <Segments />
      <Exports />
    </>
  );
}

function Group({ name, rows }: { name: string; rows: Dimension[] }) {
  if (rows.length === 0) return null;
  return (
    <table>
      <caption>{name}, mm, ± standard uncertainty</caption>
      <tbody>
        {rows.map((row) => (
          <Row key={row.id} row={row} />
        ))}
      </tbody>
    </table>
  );
}

function Row({ row }: { row: Dimension }) {
  const chosen = measuring.selected.value === row.id;
  return (
    <>
      <tr class={chosen ? "chosen" : ""}>
        <th scope="row">
          <button type="button" aria-pressed={chosen} onClick={() => measuring.select(row.id)}>
            {measuring.title(row)}
          </button>
        </th>
        <td class="figure">{row.value_mm.toFixed(1)}</td>
        <td class="figure quiet">
          {row.uncertainty_mm === null ? "" : `± ${row.uncertainty_mm.toFixed(1)}`}
        </td>
      </tr>
      {chosen && (
        <tr>
          <td class="definition" colSpan={3}>
            {displayName(row.definition)}.{row.standard && ` ${row.standard}.`}
          </td>
        </tr>
      )}
    </>
  );
}

function Segments() {
  const { body, segments } = measuring.measurements.value!;
  return (
    <details>
      <summary>Segments: volume, surface, mass</summary>
      <table>
        <thead>
          <tr>
            <th scope="col">Segment</th>
            <th scope="col">Length mm</th>
            <th scope="col">Volume cm³</th>
            <th scope="col">Area cm²</th>
            <th scope="col">Mass kg</th>
          </tr>
        </thead>
        <tbody>
          <tr class="all">
            <th scope="row">Body</th>
            <td />
            <td class="figure">{body.volume_cm3.toFixed(0)}</td>
            <td class="figure">{body.area_cm2.toFixed(0)}</td>
            <td class="figure">{body.mass_kg.toFixed(2)}</td>
          </tr>
          {segments.map((each) => (
            <tr key={each.segment}>
              <th scope="row">{displayName(each.segment)}</th>
              <td class="figure">{each.length_mm.toFixed(0)}</td>
              <td class="figure">{each.volume_closed_cm3.toFixed(0)}</td>
              <td class="figure">{each.area_cm2.toFixed(0)}</td>
              <td class="figure">{each.mass_kg.toFixed(2)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </details>
  );
}

function Exports() {
  return (
    <section aria-label="Export">
      <h3>Export</h3>
      <table class="exports">
        <tbody>
          {EXPORTS.map(([format, name, words]) => (
            <tr key={name}>
              <td>
                <button type="button" onClick={() => void measuring.downloadMeasured(format, name)}>
                  {name}
                </button>
              </td>
              <td class="quiet">{words}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p class="quiet">All of it is in the ZIP too.</p>
    </section>
  );
}
