"""Testing: reports of the verification as JUnit XML, which continuous integration shows."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from sphframe.testing.verification import Report


def write_junit(reports: Sequence[Report], path: str | Path) -> None:
    """Write a test suite per component with a test case per check; what is not declared counts as skipped."""
    root = ElementTree.Element("testsuites", name="sphframe verify")
    for report in reports:
        verdicts = [result.verdict for result in report.results]
        suite = ElementTree.SubElement(
            root, "testsuite", name=report.name, tests=str(len(verdicts) + (report.error is not None)),
            failures=str(verdicts.count("broken")), errors=str(int(report.error is not None)),
            skipped=str(verdicts.count("absent") + verdicts.count("expected")),
        )  # fmt: skip
        if report.error is not None:
            case = ElementTree.SubElement(suite, "testcase", classname=report.name, name="can be made")
            ElementTree.SubElement(case, "error", message=report.error.partition("\n")[0]).text = report.error
        for result in report.results:
            case = ElementTree.SubElement(suite, "testcase", classname=report.name, name=str(result.check))
            if result.verdict == "broken":
                text = result.failure or f"it was expected to fail ({result.expected}), but holds"
                ElementTree.SubElement(case, "failure", message=text.partition("\n")[0]).text = text
            elif result.verdict in ("absent", "expected"):
                ElementTree.SubElement(case, "skipped", message=result.expected or "not declared")
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
