"""The conversion of Markdown to the HTML of a lesson."""

from __future__ import annotations

from grader.book.markdown import anchor_of, rendered

TICKS = "```"


def test_the_title_is_not_in_the_html() -> None:
    made = rendered("# Step 03: a node\n\nSome text.\n")
    assert made.title == "Step 03: a node"
    assert made.html == "<p>Some text.</p>\n"


def test_headings_have_the_anchors_that_github_makes() -> None:
    assert anchor_of("What is in a Twist?") == "what-is-in-a-twist"
    made = rendered("# T\n\n## Check it\n\n## Check it\n")
    assert [section.anchor for section in made.sections] == ["", "check-it", "check-it-1"]
    assert '<h2 id="check-it">Check it</h2>' in made.html


def test_a_terminal_shows_what_to_type_and_what_comes() -> None:
    html = rendered(f"# T\n\n{TICKS}console ros2\n$ ros2 topic list\n/rosout\n$ echo a \\\n  b\n{TICKS}\n").html
    prompt = '<span class="prompt" aria-hidden="true">$ </span>'
    assert f"{prompt}<kbd>ros2 topic list</kbd>\n<samp>/rosout</samp>" in html
    assert f"{prompt}<kbd>echo a \\</kbd>\n<kbd>  b</kbd>" in html


def test_code_has_colours_and_nothing_in_it_is_html() -> None:
    html = rendered(f"# T\n\n{TICKS}python part\nimport rclpy  # <b>\n{TICKS}\n").html
    assert '<span class="k">import</span> rclpy' in html
    assert "&lt;b&gt;" in html


def test_html_in_markdown_is_text() -> None:
    assert "<script" not in rendered('# T\n\n<script src="x"></script> <img src=x onerror=y>\n').html
    assert "javascript:" not in rendered("# T\n\n[a](javascript:alert)\n").html.replace("(javascript:", "")


def test_links_to_lessons_lead_to_their_pages() -> None:
    html = rendered("# T\n\n[a](../02-discover-topics/lesson.md#names) [b](https://docs.ros.org/)\n").html
    assert 'href="../02-discover-topics/index.html#names"' in html
    assert 'href="https://docs.ros.org/"' in html


def test_the_empty_corner_of_a_table_is_no_header() -> None:
    html = rendered("# T\n\n| | topic |\n| --- | --- |\n| who | all |\n").html
    assert '<tr>\n<td></td>\n<th scope="col">topic</th>\n</tr>' in html


def test_a_picture_is_a_figure_with_its_text() -> None:
    made = rendered('# T\n\n![A "circle"](circle.png)\n')
    assert made.pictures == ("circle.png",)
    assert "<figure><img" in made.html
    assert "<figcaption>A &#34;circle&#34;</figcaption></figure>" in made.html


def test_the_line_with_the_neighbours_is_left_out() -> None:
    made = rendered("# T\n\nText.\n\n---\n\nPrevious: [a](../a/lesson.md)\n")
    assert made.html == "<p>Text.</p>\n"


def test_sections_have_their_plain_text() -> None:
    made = rendered(f"# T\n\nFirst `code`.\n\n## Next\n\n**Bold**\nline.\n\n{TICKS}\nx = 1\n{TICKS}\n")
    assert [(each.title, each.text) for each in made.sections] == [("T", "First code."), ("Next", "Bold line. x = 1")]


def test_a_heading_of_the_fourth_level_belongs_to_the_text_of_its_section() -> None:
    made = rendered("# T\n\n## Next\n\nFirst.\n\n#### A detail\n\nLast.\n")
    assert [(each.title, each.text) for each in made.sections] == [("T", ""), ("Next", "First. A detail Last.")]
