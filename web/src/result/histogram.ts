export interface Histogram {
  /** counts of equal bins over [0, maximum]; the last holds everything above too */
  counts: number[];
  maximum: number;
}

/** @param valuesMm distances, not negative */
export function histogram(valuesMm: Float32Array, maximum: number, bins: number): Histogram {
  const counts = new Array<number>(bins).fill(0);
  for (const value of valuesMm) {
    const bin = Math.min(Math.floor((value / maximum) * bins), bins - 1);
    if (bin >= 0) counts[bin]! += 1;
  }
  return { counts, maximum };
}
