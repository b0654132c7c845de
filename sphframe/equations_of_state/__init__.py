"""Equations of state: pressure as a function of density alone."""
