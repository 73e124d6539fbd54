"""Files of another encoding than UTF-8: which one is said where their start tells it."""

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.beside.toml_file import parse_toml

TEXT = 'name = "Größe"\n'


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_utf_8_is_read_with_a_mark_and_without(encoding):
    assert parse_toml(TEXT.encode(encoding), "s.toml") == {"name": "Größe"}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (TEXT.encode("latin-1"), "byte 10 is not UTF-8"),  # n a m e _ = _ " G r, then ö
        (TEXT.encode("utf-16"), "is UTF-16, not UTF-8"),
        (TEXT.encode("utf-16-le"), "is UTF-16, not UTF-8"),
        (TEXT.encode("utf-16-be"), "is UTF-16, not UTF-8"),
        ("name = 1\n".encode("utf-16-le"), "is UTF-16, not UTF-8"),  # valid UTF-8, of nulls
    ],
)
def test_another_encoding_is_named_in_one_line(content, said):
    with pytest.raises(InputError) as caught:
        parse_toml(content, "s.toml")
    assert str(caught.value) == f"s.toml: {said}; expected to be saved as UTF-8"
