"""Hypothesis draws the same examples in every run, so that a failure is never a matter of luck."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "flexapod", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("flexapod")
