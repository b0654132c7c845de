"""Benchmark: measurements of speed, memory and start-up that are comparable between machines and versions."""

from sphframe.benchmark.report import SECTIONS, Report, bench, check_request

__all__ = ["SECTIONS", "Report", "bench", "check_request"]
