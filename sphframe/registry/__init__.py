"""Registry: components chosen by name, found through entry points, loaded when asked for.

Built-in components are declared in the same way as those of plugins, by one line of a distribution's pyproject.toml::

    [project.entry-points."sphframe.interpolators"]
    nearest = "my_package.nearest:Nearest"

A package may say which version of the plugin interface it was written for, by ``SPHFRAME_API = (1, 0)`` in its
``__init__.py`` (before it imports its modules); a package that is too old or too new is refused with a message that
says which of the two to upgrade.
"""

from sphframe.registry.components import check, create, load
from sphframe.registry.entries import Entry, available, clear, find, is_address
from sphframe.registry.kinds import API_VERSION, COMPONENT_KINDS, KINDS
