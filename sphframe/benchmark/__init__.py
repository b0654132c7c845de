"""Benchmark: measures speed, memory and start-up, so that figures of different machines and versions compare."""

from sphframe.benchmark.report import SECTIONS, Report, bench, check_request

__all__ = ["SECTIONS", "Report", "bench", "check_request"]
