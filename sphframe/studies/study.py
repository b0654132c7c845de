"""Studies: the contract of a study, and the installed studies."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

from sphframe.errors import InputError, PluginError
from sphframe.registry import available, create
from sphframe.studies.section import Section


class Study(ABC):
    """A set of runs with the tables, figures and claims that are derived from them, such as those of a paper.

    A distribution registers its subclass under the entry-point group ``sphframe.studies``. ``title`` and ``source`` may
    be class attributes.
    """

    @property
    @abstractmethod
    def title(self) -> str:
        """Title of the report."""

    @property
    @abstractmethod
    def source(self) -> str:
        """First paragraph of the report: what is studied, with the DOI of the publication if there is one."""

    @abstractmethod
    def sections(self) -> Sequence[Section]:
        """Return the sections in the order of the report; their names differ."""


def installed_study(name: str | None = None) -> Study:
    """Return the study ``name``; without a name the only one that is installed.

    Raises
    ------
    InputError
        no name is given, and no study is installed or several are.
    PluginError
        ``name`` is not installed or cannot be used, as for :func:`sphframe.create`.
    """
    if name is None:
        names = [entry.name for entry in available("studies")]
        if not names:
            raise InputError("no study is installed; for that of Huang et al. (2019): pip install sphframe-huang2019")
        if len(names) > 1:
            titles = "".join(f"\n  {name}  {_title(name)}" for name in names)
            raise InputError(f"several studies are installed; name one of them:{titles}")
        name = names[0]
    study: Study = create("studies", name)
    return study


def _title(name: str) -> str:
    try:
        return installed_study(name).title
    except PluginError as error:
        return f"cannot be used: {error}"
