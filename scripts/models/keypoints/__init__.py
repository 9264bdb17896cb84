"""Conversion of the BlazePose networks from TFLite to ONNX."""
