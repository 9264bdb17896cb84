import type { Gender } from "../../core/types";
import { seconds } from "../../result/format";
import { change, register } from "../actions";
import { Choice } from "../Choice";
import { busy as isBusy, result, scan, settings } from "../state";

const BODIES: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
];

export function RegisterPanel() {
  const busy = isBusy.value !== null;
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  const times = Object.entries(result.value?.registration.timing_ms ?? {}).filter(([, time]) => time > 0);
  return (
    <>
      <Choice
        label="Body model"
        value={settings.value.gender}
        options={BODIES}
        disabled={busy}
        onChange={(gender) => change({ gender })}
      />
      <button type="button" class="main" disabled={busy} onClick={() => void register()}>
        {result.value ? "Register again" : "Register"} <kbd>R</kbd>
      </button>
      {times.length > 0 && (
        <table>
          <caption>Time by stage</caption>
          <tbody>
            {times.map(([name, time]) => (
              <tr key={name}>
                <th scope="row">{name}</th>
                <td class="figure">{seconds(time)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </>
  );
}
