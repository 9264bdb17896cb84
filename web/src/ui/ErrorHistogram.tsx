import { toCss, viridis } from "../result/colours";
import { percent } from "../result/format";
import { histogram } from "../result/histogram";
import { legend } from "./state";

const BINS = 30;
const WIDTH = 300;
const HEIGHT = 90;

/** How many body vertices lie how far from the scan, over the range of the error colours. */
export function ErrorHistogram({ valuesMm }: { valuesMm: Float32Array }) {
  const { counts, maximum } = histogram(valuesMm, legend.value, BINS);
  const most = Math.max(...counts, 1);
  const below = counts.slice(0, BINS / 2).reduce((sum, count) => sum + count, 0) / valuesMm.length;
  const step = WIDTH / BINS;
  return (
    <figure>
      <figcaption>Vertices by distance, mm</figcaption>
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT + 14}`}
        role="img"
        aria-label={`Histogram: ${percent(below)} of the vertices within ${maximum / 2} millimetres`}
      >
        {counts.map((count, i) => {
          const height = (count / most) * HEIGHT;
          return (
            <rect
              key={i}
              x={i * step + 0.5}
              y={HEIGHT - height}
              width={step - 1}
              height={height}
              fill={toCss(viridis((i + 0.5) / BINS))}
            />
          );
        })}
        <text x={0} y={HEIGHT + 12}>
          0
        </text>
        <text x={WIDTH / 2} y={HEIGHT + 12} text-anchor="middle">
          {maximum / 2}
        </text>
        <text x={WIDTH} y={HEIGHT + 12} text-anchor="end">
          {maximum}+
        </text>
      </svg>
    </figure>
  );
}
