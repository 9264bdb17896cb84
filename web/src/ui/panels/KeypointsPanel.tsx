import { useEffect, useRef } from "preact/hooks";
import type { ViewData } from "../../core/types";
import { confidenceColour } from "../../result/colours";
import { displayName, percent } from "../../result/format";
import { change } from "../actions";
import { Choice } from "../Choice";
import { viewCount } from "../MethodChoice";
import { RunStage } from "../RunStage";
import { busy, found, scan, settings, setView, view } from "../state";

const VIEWS: ["8" | "2", string][] = [
  ["8", "8, all round"],
  ["2", "2, front and side (paper)"],
];

export function KeypointsPanel() {
  const { keypoints } = found.value;
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  return (
    <>
      <p class="quiet">
        The scan is drawn from several sides; a pose network finds 33 landmarks in each picture.
      </p>
      <Choice
        label="Pictures"
        value={viewCount(settings.value) === 8 ? "8" : "2"}
        options={VIEWS}
        disabled={busy.value !== null}
        onChange={(value) => void change({ views: value === "8" ? 8 : 2 })}
      />
      <RunStage stage="keypoints" />
      {keypoints && (
        <>
          <label class="check">
            <input
              type="checkbox"
              checked={view.value.showKeypoints}
              onChange={(event) => setView({ showKeypoints: event.currentTarget.checked })}
            />
            Show on the scan
          </label>
          <div class="views">
            {keypoints.views.map((each, i) => (
              <ViewPicture
                key={i}
                data={each}
                label={`View ${i + 1} of ${keypoints.views.length} with landmarks`}
              />
            ))}
          </div>
          <p class="quiet">
            Confidence: <Dot confidence={0} /> low <Dot confidence={0.5} /> medium <Dot confidence={1} /> high
          </p>
          <table>
            <caption class="unseen">Joints before the fit</caption>
            <thead>
              <tr>
                <th scope="col">Joint</th>
                <th scope="col">Confidence</th>
                <th scope="col">From</th>
              </tr>
            </thead>
            <tbody>
              {keypoints.joints.map(({ joint, confidence, source }) => (
                <tr key={joint}>
                  <th scope="row">
                    <Dot confidence={confidence} /> {displayName(joint)}
                  </th>
                  <td class="figure">{source === "none" ? "–" : percent(confidence)}</td>
                  <td>{source}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </>
      )}
    </>
  );
}

function Dot({ confidence }: { confidence: number }) {
  return (
    <svg class="dot" viewBox="0 0 10 10" width={10} height={10} aria-hidden="true">
      <circle cx={5} cy={5} r={4.5} fill={confidenceColour(confidence)} />
    </svg>
  );
}

/** Share of the landmarks' extent that is left free around them. */
const MARGIN = 0.12;

/** The square part of a view that holds the body, in pixels. */
function bodySquare({ width, height, landmarks }: ViewData): { left: number; top: number; size: number } {
  const xs = landmarks.map(({ x }) => x);
  const ys = landmarks.map(({ y }) => y);
  if (landmarks.length === 0) return { left: 0, top: 0, size: Math.max(width, height) };
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const size = Math.round(Math.max(right - left, bottom - top) * (1 + 2 * MARGIN));
  return { left: Math.round((left + right - size) / 2), top: Math.round((top + bottom - size) / 2), size };
}

export function ViewPicture({ data, label }: { data: ViewData; label: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { left, top, size } = bodySquare(data);
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context) return;
    const { width, height, rgb, landmarks } = data;
    const picture = context.createImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      picture.data.set(rgb.subarray(3 * i, 3 * i + 3), 4 * i);
      picture.data[4 * i + 3] = 255;
    }
    context.putImageData(picture, -left, -top);
    const radius = size / 70;
    for (const { x, y, confidence } of landmarks) {
      context.beginPath();
      context.arc(x - left, y - top, radius, 0, 2 * Math.PI);
      context.fillStyle = confidenceColour(confidence);
      context.fill();
      context.strokeStyle = "#000a";
      context.stroke();
    }
  }, [data, left, top, size]);
  return <canvas ref={canvas} width={size} height={size} role="img" aria-label={label} />;
}
