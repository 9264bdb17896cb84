import { displayName } from "../../result/format";
import { BodyChoice } from "../BodyChoice";
import { RunStage } from "../RunStage";
import { found, scan } from "../state";

const degrees = (radians: number) => `${Math.round((radians * 180) / Math.PI)}°`;

export function PosePanel() {
  const { pose } = found.value;
  return (
    <>
      <p class="quiet">
        A body posed by the keypoints and by what poses people take, before it is fitted to the surface.
      </p>
      <BodyChoice />
      {scan.value ? <RunStage stage="pose" /> : <p class="quiet">Open a scan first.</p>}
      {pose && (
        <table>
          <caption>Turn of each joint against its parent; the skeleton is drawn in the view</caption>
          <tbody>
            {pose.joints.map(({ name, turn_rad }) => (
              <tr key={name}>
                <th scope="row">{displayName(name)}</th>
                <td class="figure">{degrees(turn_rad)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </>
  );
}
