"""Benchmark: measurements of speed, memory and start-up that are comparable between machines and versions."""

from sphframe.benchmark.report import SECTIONS, BenchmarkReport, bench, check_request

__all__ = ["SECTIONS", "BenchmarkReport", "bench", "check_request"]
