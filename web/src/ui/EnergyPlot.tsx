import { type Curve, curves } from "./energy";

const WIDTH = 300;
const HEIGHT = 110;
const LEFT = 6;
const BOTTOM = 6;
/** Okabe and Ito's colours, which colour-blind eyes tell apart; as styles, for both themes. */
const COLOURS = ["#0072b2", "#d55e00", "#009e73"];

/** The energy of each part of the published solver over its iterations, on a logarithmic scale. */
export function EnergyPlot() {
  const shown = curves.value.filter(({ points }) => points.length > 1);
  if (shown.length === 0) return null;
  const values = shown.flatMap(({ points }) => points.map(({ value }) => Math.log10(Math.max(value, 1e-12))));
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const most = Math.max(...shown.map(({ points }) => points.at(-1)!.iteration));
  const place = ({ iteration, value }: Curve["points"][number]) => {
    const x = LEFT + ((WIDTH - LEFT) * iteration) / most;
    const share = (Math.log10(Math.max(value, 1e-12)) - low) / Math.max(high - low, 1e-9);
    return `${x.toFixed(1)},${((HEIGHT - BOTTOM) * (1 - share) + 2).toFixed(1)}`;
  };
  const latest = shown.at(-1)!;
  const { iteration, value } = latest.points.at(-1)!;
  return (
    <figure class="energy">
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={`Energy of the ${latest.name} fit: ${value.toPrecision(4)} at iteration ${iteration}`}
      >
        <path class="frame" d={`M${LEFT} 0V${HEIGHT - BOTTOM + 3}H${WIDTH}`} />
        {shown.map(({ name, points }, i) => (
          <polyline
            key={name}
            points={points.map(place).join(" ")}
            style={{ stroke: COLOURS[i % COLOURS.length] }}
          />
        ))}
      </svg>
      <figcaption>
        <span>Energy over {most} iterations, logarithmic</span>
        {shown.map(({ name, points }, i) => (
          <span key={name}>
            <span aria-hidden="true" style={{ color: COLOURS[i % COLOURS.length] }}>
              ━
            </span>{" "}
            {name} {points.at(-1)!.value.toPrecision(4)}
          </span>
        ))}
      </figcaption>
    </figure>
  );
}
