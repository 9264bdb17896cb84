interface Props<T extends string> {
  label: string;
  value: T;
  options: readonly (readonly [T, string])[];
  disabled?: boolean;
  onChange(value: T): void;
}

/** A row of buttons of which one is chosen. */
export function Choice<T extends string>({ label, value, options, disabled = false, onChange }: Props<T>) {
  const name = `choice-${label.toLowerCase().replaceAll(" ", "-")}`;
  return (
    <fieldset class="choice" disabled={disabled}>
      <legend>{label}</legend>
      <div class="choices">
        {options.map(([option, text]) => (
          <label key={option}>
            <input
              type="radio"
              name={name}
              value={option}
              checked={option === value}
              onChange={() => onChange(option)}
            />
            <span>{text}</span>
          </label>
        ))}
      </div>
    </fieldset>
  );
}
