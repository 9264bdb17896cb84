// The method's formulas in MathML: drawn by the browser, read aloud by screen readers.
import type { ComponentChildren } from "preact";

/** Brackets and bars of the text's own height. As a word: the value false would leave the attribute out. */
const RIGID = { stretchy: "false" as unknown as boolean };

type Children = { children: ComponentChildren };

/** A formula in a line of its own. */
function Block({ children }: Children) {
  return (
    <div class="formula-block">
      <math display="block">{children}</math>
    </div>
  );
}

/** A formula of several lines, which a narrow panel needs: what is on the left, and the terms of each line. */
function Lines({ left, lines }: { left: ComponentChildren; lines: readonly ComponentChildren[] }) {
  return (
    <Block>
      <mtable class="lines">
        {lines.map((terms, i) => (
          <mtr key={i}>
            <mtd>
              {i === 0 && (
                <mrow>
                  {left}
                  <mo>=</mo>
                </mrow>
              )}
            </mtd>
            <mtd>
              <mrow>
                {i > 0 && <mo>+</mo>}
                {terms}
              </mrow>
            </mtd>
          </mtr>
        ))}
      </mtable>
    </Block>
  );
}

/** A name with another below it. */
function Sub({ of, at, upright = false }: { of: string; at: string; upright?: boolean }) {
  return (
    <msub>
      <mi>{of}</mi>
      {upright ? <mtext>{at}</mtext> : <mi>{at}</mi>}
    </msub>
  );
}

/** A function of what is in brackets. */
function Call({ f, children }: { f: ComponentChildren } & Children) {
  return (
    <mrow>
      {f}
      <mo {...RIGID}>(</mo>
      {children}
      <mo {...RIGID}>)</mo>
    </mrow>
  );
}

/** Arguments with commas between them. */
function list(...names: string[]): ComponentChildren {
  return names.map((name, i) => [i > 0 && <mo separator>,</mo>, <mi key={name}>{name}</mi>]);
}

function Size({ children }: Children) {
  return (
    <mrow>
      <mo {...RIGID}>|</mo>
      {children}
      <mo {...RIGID}>|</mo>
    </mrow>
  );
}

function Sum({ over }: { over: ComponentChildren }) {
  return (
    <munder>
      <mo>∑</mo>
      <mrow>{over}</mrow>
    </munder>
  );
}

/** n · (v − s): along the surface's normal. */
function AlongNormal({ s = <mi>s</mi> }: { s?: ComponentChildren }) {
  return (
    <mrow>
      <mi mathvariant="normal">n</mi>
      <mo>·</mo>
      <mo {...RIGID}>(</mo>
      <mi>v</mi>
      <mo>−</mo>
      {s}
      <mo {...RIGID}>)</mo>
    </mrow>
  );
}

function Prior({ weight, name, of }: { weight: string; name: string; of?: string }) {
  const term = <Sub of="E" at={name} upright />;
  return (
    <mrow>
      <Sub of="λ" at={weight} />
      {of ? (
        <Call f={term}>
          <mi>{of}</mi>
        </Call>
      ) : (
        term
      )}
    </mrow>
  );
}

/** Scan to body. */
export function Placement() {
  return (
    <Block>
      <Sub of="p" at="body" upright />
      <mo>=</mo>
      <mi>s</mi>
      <mi>R</mi>
      <mo>(</mo>
      <mi>p</mi>
      <mo>−</mo>
      <mi>c</mi>
      <mo>)</mo>
    </Block>
  );
}

/** A landmark in space from its places in the pictures. */
export function Triangulation() {
  return (
    <Block>
      <msup>
        <mi>x</mi>
        <mo>*</mo>
      </msup>
      <mo>=</mo>
      <munder>
        <mo>argmin</mo>
        <mi>x</mi>
      </munder>
      <Sum over={<mi>i</mi>} />
      <Sub of="w" at="i" />
      <Call f={<mi>ρ</mi>}>
        <Size>
          <Call f={<Sub of="π" at="i" />}>
            <mi>x</mi>
          </Call>
          <mo>−</mo>
          <Sub of="u" at="i" />
        </Size>
      </Call>
    </Block>
  );
}

/** The landmark fit. */
export function LandmarkEnergy() {
  const seen = (
    <>
      <Sum over={<mi>k</mi>} />
      <Sub of="w" at="k" />
      <Call f={<mi>ρ</mi>}>
        <Size>
          <Call f={<Sub of="l" at="k" />}>{list("β", "θ")}</Call>
          <mo>−</mo>
          <Sub of="x" at="k" />
        </Size>
      </Call>
    </>
  );
  const priors = (
    <>
      <Prior weight="θ" name="pose" of="θ" />
      <mo>+</mo>
      <Prior weight="β" name="shape" of="β" />
    </>
  );
  return <Lines left={<mi>E</mi>} lines={[seen, priors]} />;
}

/** The surface fit. */
export function SurfaceEnergy() {
  const pairs = (from: string, to: string) => (
    <>
      <Sum
        over={
          <>
            <mi>{from}</mi>
            <mo>→</mo>
            <mi>{to}</mi>
          </>
        }
      />
      <Call f={<mi>ρ</mi>}>
        <AlongNormal />
      </Call>
    </>
  );
  const distances = (
    <>
      {pairs("v", "s")}
      <mo>+</mo>
      {pairs("s", "v")}
    </>
  );
  const priors = (
    <>
      <Prior weight="θ" name="pose" />
      <mo>+</mo>
      <Prior weight="β" name="shape" />
    </>
  );
  return <Lines left={<mi>E</mi>} lines={[distances, priors]} />;
}

/** What is left between a vertex and the scan. */
export function Residual() {
  return (
    <Block>
      <Sub of="r" at="v" />
      <mo>=</mo>
      <Size>
        <AlongNormal
          s={
            <Call f={<mi>s</mi>}>
              <mi>v</mi>
            </Call>
          }
        />
      </Size>
    </Block>
  );
}

/** The body model. */
export function Model() {
  return (
    <Block>
      <Call f={<mi>M</mi>}>{list("β", "θ")}</Call>
      <mo>=</mo>
      <Call f={<mi>W</mi>}>
        <mi>T</mi>
        <mo>+</mo>
        <Call f={<Sub of="B" at="S" upright />}>
          <mi>β</mi>
        </Call>
        <mo>+</mo>
        <Call f={<Sub of="B" at="P" upright />}>
          <mi>θ</mi>
        </Call>
        <mo separator>,</mo>
        <Call f={<mi>J</mi>}>
          <mi>β</mi>
        </Call>
        <mo separator>,</mo>
        <mi>θ</mi>
      </Call>
    </Block>
  );
}

/** A name with its index in running text. */
export function Named({ of, at }: { of: string; at: string }) {
  return (
    <math>
      <Sub of={of} at={at} />
    </math>
  );
}
