"""The array file: round trips of every type, and refusal of damaged files."""
import unittest

import numpy as np

import support  # noqa: F401  (sets the import path)
import array_file


class ArrayFile(unittest.TestCase):
    def arrays(self):
        rng = np.random.default_rng(4)
        out = {d.name: rng.integers(0, 100, (3, 5)).astype(d) for d in array_file.TYPES}
        out.update(text="two\nlines", smooth=np.arange(4000, dtype="<i4").reshape(10, 20, 20), none=np.zeros(0, "<u2"))
        return out

    def test_round_trip(self):
        arrays = self.arrays()
        back = array_file.decode(array_file.encode("TEST", arrays), "TEST")
        self.assertEqual(list(back), list(arrays))
        for name, value in arrays.items():
            if name == "text":
                self.assertEqual(back[name].tobytes().decode(), value)
            else:
                np.testing.assert_array_equal(back[name], value)
                self.assertEqual(back[name].dtype, value.dtype)

    def test_every_payload_starts_on_eight_bytes(self):
        data = array_file.encode("TEST", self.arrays())
        count, _ = array_file.COUNT.unpack_from(data, array_file.HASHED_FROM)
        self.assertEqual(array_file.ENTRY.size, 88)
        for k in range(count):
            entry = array_file.ENTRY.unpack_from(data, 64 + 88 * k)
            self.assertEqual(entry[9] % 8, 0)

    def test_damage_is_noticed(self):
        data = array_file.encode("TEST", self.arrays())
        for place in (0, 9, 20, 40, 70, len(data) - 1):
            broken = bytearray(data)
            broken[place] ^= 1
            with self.assertRaises(array_file.ArrayFileError, msg=place):
                array_file.decode(bytes(broken), "TEST")
        for length in (0, 10, 63, len(data) - 1):
            with self.assertRaises(array_file.ArrayFileError):
                array_file.decode(data[:length], "TEST")
        with self.assertRaises(array_file.ArrayFileError):
            array_file.decode(data, "BODY")

    def test_quantisation_error_is_half_a_step(self):
        values = np.random.default_rng(5).normal(size=(4, 30, 3)) * np.array([1, 10, 0.1, 0])[:, None, None]
        integers, scale = array_file.quantised(values, per_first_axis=True)
        self.assertEqual(scale.shape, (4,))
        back = array_file.real({"x": integers, "x.scale": scale}, "x")
        self.assertTrue((np.abs(back - values).max((1, 2)) <= scale * 0.51).all())
        np.testing.assert_array_equal(array_file.quantised(-values)[0], -array_file.quantised(values)[0])


if __name__ == "__main__":
    unittest.main()
