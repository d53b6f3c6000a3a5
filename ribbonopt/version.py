"""The version of ribbonopt, in one place."""

VERSION = "0.2.0"
