"""Output: writes a run into one NetCDF file, which xarray can open at any time."""

from sphframe.output.checkpoint_writer import CheckpointWriter
from sphframe.output.reader import open_dataset
from sphframe.output.writer import NetCDFWriter

__all__ = ["CheckpointWriter", "NetCDFWriter", "open_dataset"]
