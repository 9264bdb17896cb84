import { useRef } from "preact/hooks";
import { save } from "../result/download";

const WIDTH = 400;
const HEIGHT = 150;
const LEFT = 38;
const BOTTOM = 18;
const GREY = "#7d8890";

export interface Series {
  name: string;
  colour: string;
  values: readonly number[];
}

interface Props {
  title: string;
  series: readonly Series[];
  /** what the lower axis counts, from and to */
  range: readonly [string, string];
  logarithmic?: boolean;
  /** index that is marked */
  marked?: number;
  onPick?: (index: number) => void;
}

/** Curves over one axis, which can be taken along as SVG or PNG. */
export function Plot({ title, series, range, logarithmic = false, marked, onPick }: Props) {
  const drawing = useRef<SVGSVGElement>(null);
  const values = series.flatMap((each) => each.values).filter((value) => Number.isFinite(value));
  const positive = values.filter((value) => value > 0);
  const high = Math.max(...values, 1e-9);
  const low = logarithmic ? Math.max(Math.min(...positive, high), high / 1e5) : 0;
  const scaled = (value: number) =>
    logarithmic ? Math.log(Math.max(value, low) / low) / Math.log(Math.max(high / low, 1.001)) : value / high;
  const length = Math.max(...series.map((each) => each.values.length), 2);
  const x = (i: number) => LEFT + (i / (length - 1)) * (WIDTH - LEFT - 4);
  const y = (value: number) => HEIGHT - BOTTOM - scaled(value) * (HEIGHT - BOTTOM - 8);
  const pick = (event: MouseEvent) => {
    const box = drawing.current!.getBoundingClientRect();
    const share = (((event.clientX - box.left) / box.width) * WIDTH - LEFT) / (WIDTH - LEFT - 4);
    onPick?.(Math.round(Math.min(Math.max(share, 0), 1) * (length - 1)));
  };
  return (
    <figure class="plot">
      <figcaption>
        <span>{title}</span>
        <span>
          <button
            type="button"
            aria-label={`${title}, as SVG`}
            onClick={() => saveSvg(drawing.current!, title)}
          >
            SVG
          </button>{" "}
          <button
            type="button"
            aria-label={`${title}, as PNG`}
            onClick={() => void savePng(drawing.current!, title)}
          >
            PNG
          </button>
        </span>
      </figcaption>
      {/* biome-ignore lint/a11y/useKeyWithClickEvents: the film's slider does the same by keyboard */}
      <svg
        ref={drawing}
        xmlns="http://www.w3.org/2000/svg"
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        width={WIDTH}
        height={HEIGHT}
        font-family="sans-serif"
        font-size={10}
        role="img"
        aria-label={`${title}: ${series.map((each) => `${each.name} ${short(each.values.at(-1) ?? 0)} at the end`).join(", ")}`}
        onClick={pick}
      >
        <path d={`M${LEFT} 4V${HEIGHT - BOTTOM}H${WIDTH - 4}`} fill="none" stroke={GREY} stroke-width={1} />
        {[high, low].map((value) => (
          <text key={value} x={LEFT - 4} y={y(value) + 4} text-anchor="end" fill={GREY}>
            {short(value)}
          </text>
        ))}
        <text x={LEFT} y={HEIGHT - 5} fill={GREY}>
          {range[0]}
        </text>
        <text x={WIDTH - 4} y={HEIGHT - 5} text-anchor="end" fill={GREY}>
          {range[1]}
        </text>
        {series.map(({ name, colour, values }) => (
          <polyline
            key={name}
            points={values.map((value, i) => `${x(i).toFixed(1)},${y(value).toFixed(1)}`).join(" ")}
            fill="none"
            stroke={colour}
            stroke-width={1.8}
          />
        ))}
        {marked !== undefined && (
          <path d={`M${x(marked).toFixed(1)} 4V${HEIGHT - BOTTOM}`} stroke={GREY} stroke-dasharray="3 2" />
        )}
      </svg>
      <ul class="key">
        {series.map(({ name, colour }) => (
          <li key={name} style={{ "--of": colour }}>
            {name}
          </li>
        ))}
      </ul>
    </figure>
  );
}

function short(value: number): string {
  return value === 0 ? "0" : value >= 100 ? value.toFixed(0) : value.toPrecision(2);
}

function fileName(title: string): string {
  return title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-");
}

function textOf(drawing: SVGSVGElement): string {
  return new XMLSerializer().serializeToString(drawing);
}

function saveSvg(drawing: SVGSVGElement, title: string): void {
  save(`${fileName(title)}.svg`, new Blob([textOf(drawing)], { type: "image/svg+xml" }));
}

/** At three times its size, on white. */
async function savePng(drawing: SVGSVGElement, title: string): Promise<void> {
  const url = URL.createObjectURL(new Blob([textOf(drawing)], { type: "image/svg+xml" }));
  try {
    const picture = new Image();
    picture.src = url;
    await picture.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [3 * WIDTH, 3 * HEIGHT];
    const context = canvas.getContext("2d")!;
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(picture, 0, 0, canvas.width, canvas.height);
    const png = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
    if (png) save(`${fileName(title)}.png`, png);
  } finally {
    URL.revokeObjectURL(url);
  }
}
