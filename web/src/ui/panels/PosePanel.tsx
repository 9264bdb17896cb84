import type { Vec3 } from "../../core/types";
import { displayName } from "../../result/format";
import { RegisterHere } from "../RegisterHere";
import { result, scan } from "../state";

const degrees = ([x, y, z]: Vec3) => `${Math.round((Math.hypot(x, y, z) * 180) / Math.PI)}°`;

export function PosePanel() {
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  const registration = result.value?.registration;
  const pose = registration?.parameters?.pose;
  return (
    <>
      <p class="quiet">
        The pose starts from the keypoints and from what poses people take, and is then fitted to the surface
        together with the shape.
      </p>
      {pose && registration ? (
        <table>
          <caption>Rotation of each joint against its parent; the skeleton is drawn in the view</caption>
          <tbody>
            {registration.joints.map(({ name }, i) => (
              <tr key={name}>
                <th scope="row">{displayName(name)}</th>
                <td class="figure">{degrees(pose.slice(3 * i, 3 * i + 3) as unknown as Vec3)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      ) : (
        <RegisterHere stage="pose" />
      )}
    </>
  );
}
