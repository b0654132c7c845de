"""Studies: the league table: every method on every benchmark, scored and ranked."""

from sphframe.studies.league.entrants import Benchmarked, Method, installed_benchmarks, installed_methods
from sphframe.studies.league.rank import League, rank

__all__ = ["Benchmarked", "League", "Method", "installed_benchmarks", "installed_methods", "rank"]
