"""Finds plug-ins by entry point, builds them from their options, quarantines broken ones.

Importing this package and listing plug-ins import no plug-in, no numpy and no pydantic.
"""

from stackloft.registry.build import build, failure, instantiate, options_of, parse_settings, schema_of
from stackloft.registry.choose_reader import Probe, choose_reader, describe, probe_all
from stackloft.registry.fields import OptionField, fields_of
from stackloft.registry.find import find, locate, nearest
from stackloft.registry.loading import Loaded, Quarantined, load, rescan
from stackloft.registry.member_checks import RUN
from stackloft.registry.options_model import plain, schema, validate
from stackloft.registry.scan import Listing, catalogue

__all__ = [
    "RUN",
    "Listing",
    "Loaded",
    "OptionField",
    "Probe",
    "Quarantined",
    "build",
    "catalogue",
    "choose_reader",
    "describe",
    "failure",
    "fields_of",
    "find",
    "instantiate",
    "load",
    "locate",
    "nearest",
    "options_of",
    "parse_settings",
    "plain",
    "probe_all",
    "rescan",
    "schema",
    "schema_of",
    "validate",
]
