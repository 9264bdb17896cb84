import { useSignal } from "@preact/signals";
import type { Section } from "../core/measurements";
import { displayName } from "../result/format";
import { Choice } from "./Choice";
import { chooseSegment, measurements, profile, showSection } from "./measuring";

const WIDTH = 340;
const HEIGHT = 150;
const LEFT = 42;
const BOTTOM = 18;

type Quantity = "perimeter_hull_mm" | "area_cm2" | "breadth_mm" | "depth_mm";
const QUANTITIES: [Quantity, string, string][] = [
  ["perimeter_hull_mm", "Girth", "mm"],
  ["area_cm2", "Area", "cm²"],
  ["breadth_mm", "Breadth", "mm"],
  ["depth_mm", "Depth", "mm"],
];

/** Sections along a segment, from joint to joint; the one pointed at is drawn on the body. */
export function Profile() {
  const quantity = useSignal<Quantity>("perimeter_hull_mm");
  const data = profile.value;
  return (
    <section aria-label="Profile">
      <h3>Profile along a segment</h3>
      <label class="row">
        Segment
        <select
          aria-label="Segment of the profile"
          value={data?.segment ?? ""}
          onChange={(event) => void chooseSegment(event.currentTarget.value)}
        >
          <option value="">choose…</option>
          {measurements.value?.segments.map(({ segment }) => (
            <option key={segment} value={segment}>
              {displayName(segment)}
            </option>
          ))}
        </select>
      </label>
      {data && (
        <>
          <Choice
            label="Quantity"
            value={quantity.value}
            options={QUANTITIES.map(([key, text]) => [key, text] as const)}
            onChange={(value) => {
              quantity.value = value;
            }}
          />
          <Plot sections={data.sections} at={data.at} quantity={quantity.value} />
        </>
      )}
    </section>
  );
}

interface PlotProps {
  sections: Section[];
  at: number | null;
  quantity: Quantity;
}

function Plot({ sections, at, quantity }: PlotProps) {
  const [, name, unit] = QUANTITIES.find(([key]) => key === quantity)!;
  const values = sections.map((section) => section[quantity]);
  const known = values.filter((value) => value !== null);
  if (known.length === 0) return <p class="quiet">No plane across this segment meets its skin.</p>;
  const step = roundStep(Math.max(...known) / 4);
  const top = step * Math.ceil(Math.max(...known) / step);
  const x = (i: number) => LEFT + ((WIDTH - LEFT - 6) * i) / (sections.length - 1);
  const y = (value: number) => 6 + (HEIGHT - BOTTOM - 6) * (1 - value / top);
  const ticks = Array.from({ length: Math.round(top / step) + 1 }, (_, i) => i * step);
  const value = at === null ? null : values[at];
  const pointAt = (event: PointerEvent) => {
    const box = (event.currentTarget as SVGElement).getBoundingClientRect();
    const share = ((event.clientX - box.left) / box.width) * WIDTH - LEFT;
    const i = Math.round((share / (WIDTH - LEFT - 6)) * (sections.length - 1));
    showSection(Math.min(Math.max(i, 0), sections.length - 1));
  };
  return (
    <figure class="profile">
      <figcaption>
        {name}, {unit}, from the proximal joint to the distal one
      </figcaption>
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={`${name} along the segment, ${Math.min(...known).toFixed(0)} to ${Math.max(...known).toFixed(0)} ${unit}`}
        onPointerMove={pointAt}
        onPointerDown={pointAt}
      >
        {ticks.map((tick) => (
          <g key={tick}>
            <line class="grid" x1={LEFT} x2={WIDTH - 6} y1={y(tick)} y2={y(tick)} />
            <text x={LEFT - 5} y={y(tick) + 4} text-anchor="end">
              {Number(tick.toPrecision(3))}
            </text>
          </g>
        ))}
        {[0, 0.5, 1].map((t) => (
          <text
            key={t}
            x={x(t * (sections.length - 1))}
            y={HEIGHT - 3}
            text-anchor={t === 1 ? "end" : "middle"}
          >
            {100 * t} %
          </text>
        ))}
        <path d={pathOf(values, x, y)} />
        {at !== null && value !== null && value !== undefined && <circle cx={x(at)} cy={y(value)} r={4} />}
      </svg>
      <label class="slider">
        Section
        <input
          type="range"
          min={0}
          max={sections.length - 1}
          value={at ?? 0}
          aria-valuetext={at === null ? "none" : `${Math.round(100 * sections[at]!.t)} percent`}
          onInput={(event) => showSection(Number(event.currentTarget.value))}
        />
      </label>
      <p class="quiet" aria-live="polite">
        {at === null
          ? "Move over the plot or the slider to draw a section on the body."
          : `At ${Math.round(100 * sections[at]!.t)} %: ${
              value === null || value === undefined
                ? "the plane misses the segment"
                : `${value.toFixed(1)} ${unit}`
            }`}
      </p>
    </figure>
  );
}

/** A broken line: a new piece after each section that the plane missed. */
function pathOf(values: (number | null)[], x: (i: number) => number, y: (value: number) => number): string {
  return values
    .map((value, i) => {
      if (value === null) return "";
      const begins = i === 0 || values[i - 1] === null;
      return `${begins ? "M" : "L"}${x(i).toFixed(1)},${y(value).toFixed(1)}`;
    })
    .join("");
}

/** 1, 2 or 5 times a power of ten, not below `least`. */
function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(least, 1e-6)));
  return power * ([1, 2, 5].find((each) => each * power >= least) ?? 10);
}
