"""The results of a study as typed values: written as ``study.json``, and read by the report and the terminal.

`StudyDocument` is the only model of these results. The steps of a study fill it, `StudyDocument.to_dict` is
the content of the file, and `StudyDocument.read` takes it back without loss.
"""
