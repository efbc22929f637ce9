"""A page of headings, paragraphs, tables and pictures, as HTML and as Markdown."""

import html

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1240px; padding: 0 1em; color: #222; }
h1 { font-size: 1.5em; } h2 { font-size: 1.25em; margin-top: 2em; } h3 { font-size: 1.05em; }
table { border-collapse: collapse; margin: 0.5em 0 1em; } th, td { padding: 3px 10px; text-align: right; border-bottom: 1px solid #ddd; vertical-align: top; }
th { background: #f3f3f3; } td:first-child, th:first-child { text-align: left; } img { max-width: 100%; }
pre { background: #f3f3f3; padding: 0.6em; overflow-x: auto; } .pictures td { border: none; text-align: center; color: #666; }
"""


class Document:
    def __init__(self, title):
        self.title = title
        self.blocks = []

    def heading(self, text, level=2):
        self.blocks.append(("heading", level, text))

    def text(self, text):
        self.blocks.append(("text", text))

    def code(self, text):
        self.blocks.append(("code", text))

    def table(self, header, rows):
        """Cells are texts; of the same number in every row."""
        self.blocks.append(("table", [str(cell) for cell in header], [[str(cell) for cell in row] for row in rows]))

    def pictures(self, rows):
        """Rows of (file relative to the page, caption)."""
        self.blocks.append(("pictures", rows))

    def as_html(self):
        body = "\n".join(HTML[block[0]](*block[1:]) for block in self.blocks)
        title = html.escape(self.title)
        return (f"<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>{title}</title><style>{STYLE}</style></head><body>\n"
                f"<h1>{title}</h1>\n{body}\n</body></html>\n")

    def as_markdown(self):
        return f"# {self.title}\n\n" + "\n\n".join(MARKDOWN[block[0]](*block[1:]) for block in self.blocks) + "\n"


def html_table(header, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return "<table>\n" + "\n".join([line(header, "th")] + [line(row, "td") for row in rows]) + "\n</table>"


def html_pictures(rows):
    def cell(file, caption):
        return f"<td><img src='{html.escape(file)}' alt='{html.escape(caption)}'><br>{html.escape(caption)}</td>"

    return "<table class='pictures'>" + "\n".join("<tr>" + "".join(cell(*picture) for picture in row) + "</tr>" for row in rows) + "</table>"


def markdown_table(header, rows):
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in [header] + rows]
    return "\n".join([lines[0], "|---" * len(header) + "|"] + lines[1:])


def markdown_pictures(rows):
    return markdown_table([" "] * max(map(len, rows)), [[f"![{caption}]({file})<br>{caption}" for file, caption in row] for row in rows])


HTML = {
    "heading": lambda level, text: f"<h{level}>{html.escape(text)}</h{level}>",
    "text": lambda text: f"<p>{html.escape(text)}</p>",
    "code": lambda text: f"<pre>{html.escape(text)}</pre>",
    "table": html_table,
    "pictures": html_pictures,
}
MARKDOWN = {
    "heading": lambda level, text: "#" * level + " " + text,
    "text": lambda text: text,
    "code": lambda text: f"```\n{text}\n```",
    "table": markdown_table,
    "pictures": markdown_pictures,
}
