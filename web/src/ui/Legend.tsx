import { toCss, viridis } from "../result/colours";
import { legend, setView, view } from "./state";

const STEPS = 24;
const MAXIMA = [1, 2, 5, 10, 20, 50, 100];

/** The error colours in millimetres; its upper end can be chosen. */
export function Legend() {
  const maximum = legend.value;
  return (
    <div class="legend">
      <span id="legend-title">Distance to the scan, mm</span>
      <svg
        viewBox={`0 0 ${STEPS} 1`}
        preserveAspectRatio="none"
        role="img"
        aria-label={`Colours from dark violet at 0 to yellow at ${maximum} millimetres and above`}
      >
        {Array.from({ length: STEPS }, (_, i) => i).map((i) => (
          <rect key={i} x={i} y={0} width={1.05} height={1} fill={toCss(viridis((i + 0.5) / STEPS))} />
        ))}
      </svg>
      <div class="legend-ticks">
        <span>0</span>
        <span>{maximum / 2}</span>
        <span>{maximum}+</span>
      </div>
      <label>
        Scale
        <select
          value={view.value.legendMaximum ?? "auto"}
          onChange={(event) => {
            const { value } = event.currentTarget;
            setView({ legendMaximum: value === "auto" ? null : Number(value) });
          }}
        >
          <option value="auto">fitted</option>
          {MAXIMA.map((each) => (
            <option key={each} value={each}>
              0–{each} mm
            </option>
          ))}
        </select>
      </label>
    </div>
  );
}
