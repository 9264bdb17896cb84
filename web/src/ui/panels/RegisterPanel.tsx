import { seconds } from "../../result/format";
import { BodyChoice } from "../BodyChoice";
import { DetailChoice } from "../DetailChoice";
import { EnergyPlot } from "../EnergyPlot";
import { MethodChoice } from "../MethodChoice";
import { RunStage } from "../RunStage";
import { busy, result, scan } from "../state";
import { ViewControls } from "../ViewControls";

/** Entries of timing_ms, in the order of the work. */
const TIMES = [
  ["read", "Read the scan"],
  ["align", "Find up"],
  ["project", "Draw the pictures"],
  ["detect", "Find keypoints"],
  ["pose", "Pose the body"],
  ["fit", "Fit"],
  ["refine", "Refine and measure"],
  ["detail", "Detail"],
  ["total", "Total"],
] as const;

export function RegisterPanel() {
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  const registered = result.value;
  const times = registered?.registration.timing_ms ?? {};
  return (
    <>
      <p class="quiet">
        Pose and shape are fitted to the surface together, from coarse to fine; then the distances are
        measured.
      </p>
      <BodyChoice />
      <MethodChoice />
      <DetailChoice />
      <RunStage stage="register" />
      {busy.value === null && <EnergyPlot />}
      {registered && <ViewControls />}
      {registered && (
        <table>
          <caption>Time by stage</caption>
          <tbody>
            {TIMES.filter(([key]) => (times[key] ?? 0) > 0).map(([key, name]) => (
              <tr key={key} class={key === "total" ? "all" : ""}>
                <th scope="row">{name}</th>
                <td class="figure">{seconds(times[key] ?? 0)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </>
  );
}
