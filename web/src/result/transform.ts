import type { Matrix, Vec3 } from "../core/types";

/** `matrix` (four rows of four, affine) times a point. */
export function transformPoint(matrix: Matrix, [x, y, z]: Vec3): [number, number, number] {
  const row = (i: number) => {
    const [a, b, c, d] = matrix[i] as [number, number, number, number];
    return a * x + b * y + c * z + d;
  };
  return [row(0), row(1), row(2)];
}

/** Rows of four to the 16 numbers, column by column, that three.js takes. */
export function columnMajor(matrix: Matrix): number[] {
  return [0, 1, 2, 3].flatMap((column) => matrix.map((row) => row[column]!));
}
