"""Output: a run becomes one NetCDF file that xarray opens at any moment."""

from sphframe.output.checkpoint_writer import CheckpointWriter
from sphframe.output.reader import open_dataset
from sphframe.output.writer import NetCDFWriter

__all__ = ["CheckpointWriter", "NetCDFWriter", "open_dataset"]
