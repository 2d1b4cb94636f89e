"""Shows one page of the help; links are asked for, and an example can be dragged out of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from PySide6.QtCore import QPoint, Qt, QTimer, QUrl, Signal
from PySide6.QtGui import (
    QFontInfo,
    QMouseEvent,
    QPixmap,
    QResizeEvent,
    QTextCursor,
    QTextDocument,
    QTextOption,
    QWheelEvent,
)
from PySide6.QtWidgets import QPushButton, QTextBrowser, QWidget

from nep_studio.blocks.operations.copying import Clip, paste
from nep_studio.blocks.program import PAGES
from nep_studio.blocks.text import sentence
from nep_studio.help.texts import Example, examples
from nep_studio.ui.canvas.block_pictures import PictureLook, arrange, help_picture_of
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.colours import Theme, load_theme
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.theme.look import Look, code_font
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import is_right_to_left, language_code, tr
from nep_studio.ui.workbench.placing import free_place

from .repository import CHOOSE, DRAG, EXAMPLE, PICTURE, Book, Page, sample_clip

# How pages of the help look: their style sheet, from the theme and the size of the text.

H1, H2, H3, SMALL = 1.35, 1.15, 1.0, 0.92
"""Sizes of titles and small words, beside the size of the text."""


def style(theme: Theme, points: float) -> str:
    """The style sheet of a page, in the part of CSS that Qt knows."""

    def colour(name: str) -> str:
        return theme.colour(name).name()

    code = QFontInfo(code_font(points)).family()
    line, muted, text = colour("line"), colour("muted"), colour("text")
    return f"""
        body, p, li, td, th {{ color: {text}; font-size: {points:.1f}pt; }}
        h1 {{ font-size: {points * H1:.1f}pt; font-weight: 600; color: {text}; }}
        h2 {{ font-size: {points * H2:.1f}pt; font-weight: 600; color: {text}; margin-top: 14px; }}
        h3 {{ font-size: {points * H3:.1f}pt; font-weight: 600; color: {text}; margin-top: 10px; }}
        a {{ color: {colour("link")}; }}
        li {{ margin-bottom: 3px; }}
        .hint {{ color: {muted}; font-size: {points * SMALL:.1f}pt; }}
        code, pre {{ font-family: '{code}'; }}
        pre {{ color: {text}; }}
        .table {{ border-collapse: collapse; border: 1px solid {line}; }}
        .table td, .table th {{ border: 1px solid {line}; padding: 5px; }}
        .table th {{ background-color: {colour("panel_alt")}; font-weight: 600; text-align: left; }}
        .tip, .code {{ margin-top: 8px; margin-bottom: 4px; }}
        .tip td {{ background-color: {colour("info_panel")}; padding: 8px; }}
        .code td {{ background-color: {colour("panel_alt")}; padding: 8px; }}
    """


HELP = "help:"
ZOOM_STEP, LEAST_ZOOM, MOST_ZOOM = 1.15, 0.6, 3.0
BLOCK_SCALE = 0.85
"""How large blocks are beside those of the canvas at its usual size."""

PRINTED_THEME = "light"
NARROWEST = 120


class HelpBrowser(QTextBrowser):
    """A page. ``page_asked`` brings the name of another one that a person wants to see.

    ``example_chosen`` brings the name of one of several examples of a page, to do more with it.
    """

    page_asked = Signal(str)
    example_chosen = Signal(str)
    zoom_changed = Signal(float)

    def __init__(
        self, canvas: Canvas, look: Look, book: Callable[[], Book], parent: QWidget
    ) -> None:
        super().__init__(parent)
        self._canvas, self._look, self._book = canvas, look, book
        self.page: Page | None = None
        self.zoom = 1.0
        self._drawn_for = 0
        self._again = QTimer(self, singleShot=True, interval=200)
        self._again.timeout.connect(self._on_width_settled)
        self.setOpenLinks(False)
        self.setFrameShape(QTextBrowser.Shape.NoFrame)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
        labelled(self, name="Page of the help")
        self.anchorClicked.connect(self._on_link_clicked)

    # What is shown

    def show_page(self, page: Page, anchor: str = "", place: int = 0) -> None:
        """Show a page, at a place of it: one with a name, or where it was scrolled to."""
        self.page = page
        self._fill(page.html)
        if anchor:
            self._go_to(anchor)
        else:
            self.verticalScrollBar().setValue(place)

    def refresh(self) -> None:
        """Show the same page again in the look in use."""
        if self.page is None:
            return
        bar = self.verticalScrollBar()
        is_at_top = bar.value() == 0
        first = self.cursorForPosition(QPoint(1, 1)).position()
        self._fill(self.page.html)
        cursor = QTextCursor(self.document())
        cursor.setPosition(min(first, self.document().characterCount() - 1))
        bar.setValue(0 if is_at_top else bar.value() + self.cursorRect(cursor).top())

    def set_zoom(self, zoom: float) -> None:
        """Make text and pictures larger or smaller; 1 is the usual size."""
        self.zoom = min(max(zoom, LEAST_ZOOM), MOST_ZOOM)
        self.refresh()
        self.zoom_changed.emit(self.zoom)

    def printed(self, widest: float) -> QTextDocument:
        """The page for paper: dark on light, whatever the theme is."""
        document = QTextDocument(self)
        theme = load_theme(PRINTED_THEME)
        look = replace(self.picture_look(theme), widest=widest, ratio=3.0)
        html = self.page.html if self.page is not None else ""
        for address in [part.partition('"')[0] for part in html.split('<img src="')[1:]]:
            picture = self._picture(QUrl(address), look)
            document.addResource(QTextDocument.ResourceType.ImageResource, QUrl(address), picture)
        document.setDefaultTextOption(self._text_option())
        document.setDefaultStyleSheet(style(theme, QFontInfo(self.font()).pointSizeF()))
        document.setHtml(html)
        return document

    def picture_look(self, theme: Theme | None = None) -> PictureLook:
        """How pictures on this page are drawn."""
        canvas = self._canvas
        size = QFontInfo(self.font()).pixelSize() / QFontInfo(canvas.look.block_font).pixelSize()
        return PictureLook(
            theme or self._look.theme,
            canvas.look.block_font,
            canvas.look.measures.is_mirrored,
            self.devicePixelRatioF(),
            BLOCK_SCALE * size * self.zoom,
            max(NARROWEST, self.viewport().width() - 4 * self.document().documentMargin()),
        )

    def loadResource(self, kind: int, name: QUrl | str) -> object:
        """Draw a picture that the page has; nothing else is ever loaded."""
        url = QUrl(name) if isinstance(name, str) else name
        if kind == QTextDocument.ResourceType.ImageResource.value:
            return self._picture(url, self.picture_look())
        return None

    def _fill(self, html: str) -> None:
        self._drawn_for = self.viewport().width()
        document = self.document()
        points = QFontInfo(self.font()).pointSizeF() * self.zoom
        document.setDocumentMargin(self.fontMetrics().height() * 0.7)
        document.setIndentWidth(self.fontMetrics().height() * 1.3 * self.zoom)
        document.setDefaultTextOption(self._text_option())
        document.setDefaultStyleSheet(style(self._look.theme, points))
        self.setHtml(html)

    def _text_option(self) -> QTextOption:
        option = QTextOption()
        option.setWrapMode(QTextOption.WrapMode.WrapAtWordBoundaryOrAnywhere)
        right, left = Qt.LayoutDirection.RightToLeft, Qt.LayoutDirection.LeftToRight
        option.setTextDirection(right if is_right_to_left() else left)
        return option

    def _picture(self, url: QUrl, look: PictureLook) -> QPixmap:
        kind, name = url.scheme() + ":", url.path()
        language = self._book().language
        if kind == PICTURE and name in language.definitions:
            clip = sample_clip(language, language.definitions[name])
            return help_picture_of(clip.project, language, look)
        if kind == EXAMPLE and name in examples():
            clip = examples()[name].clip(language, language_code())
            return help_picture_of(clip.project, language, look)
        return QPixmap()

    def _go_to(self, anchor: str) -> None:
        """Scroll to a named place, and let the keyboard and the screen reader be there."""
        self.scrollToAnchor(anchor)
        block = self.document().begin()
        while block.isValid():
            iterator = block.begin()
            while not iterator.atEnd():
                if anchor in iterator.fragment().charFormat().anchorNames():
                    cursor = QTextCursor(self.document())
                    cursor.setPosition(iterator.fragment().position())
                    self.setTextCursor(cursor)
                    self.scrollToAnchor(anchor)
                    return
                iterator += 1
            block = block.next()

    # What a person does

    def _on_link_clicked(self, url: QUrl) -> None:
        address = url.toString()
        if address.startswith(HELP):
            self.page_asked.emit(address.removeprefix(HELP))
        elif address.startswith(CHOOSE):
            self.example_chosen.emit(address.removeprefix(CHOOSE))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to drag an example out of the page."""
        place = event.position().toPoint()
        if event.button() == Qt.MouseButton.LeftButton and self._begin_drag(place, event):
            return
        super().mousePressEvent(event)

    def _begin_drag(self, place: QPoint, event: QMouseEvent) -> bool:
        address = self.anchorAt(place)
        example = examples().get(address.removeprefix(DRAG))
        if not address.startswith(DRAG) or example is None:
            return False
        kind = self._canvas.editor.project.kind_of_page(self._canvas.page)
        clip = example.clip(self._book().language, language_code(), kind)
        if clip.stacks:
            where = event.globalPosition().toPoint()
            self._canvas.begin_external_drag(clip, where, self.viewport())
        return True

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll, or zoom with Ctrl."""
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            way = event.angleDelta().y()
            self.set_zoom(self.zoom * (ZOOM_STEP if way > 0 else 1 / ZOOM_STEP))
            event.accept()
            return
        super().wheelEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw the pictures again when the width has settled."""
        super().resizeEvent(event)
        if self.page is not None and self.viewport().width() != self._drawn_for:
            self._again.start()

    def _on_width_settled(self) -> None:
        if self.viewport().width() != self._drawn_for and self.isVisible():
            self.refresh()


# The buttons below a page that has an example: put it on the page, or try it.


class ExampleBar(QWidget):
    """Acts on the example of the page. ``try_requested`` brings a project that can run."""

    try_requested = Signal(object)

    def __init__(self, canvas: Canvas, book: Callable[[], Book], parent: QWidget) -> None:
        super().__init__(parent)
        self._canvas, self._book = canvas, book
        self._example: Example | None = None
        self._title = ""
        self.can_insert = True
        self.insert, self.try_it = QPushButton(), QPushButton()
        labelled(self.insert, text="Put it on the page")
        labelled(self.insert, tip="Put the blocks of the example into your program")
        labelled(self.try_it, text="Try it", tip="Run the example as a project of its own")
        self.try_it.setProperty("kind", "primary")
        self.insert.clicked.connect(self.put_on_page)
        self.try_it.clicked.connect(self.ask_to_try)
        gap = self.fontMetrics().height() // 3
        in_row((self.insert, 1), (self.try_it, 1), of=self, margins=gap)
        self.hide()

    def show_example(self, example: Example | None, title: str) -> None:
        """Act on this example; without one there are no buttons."""
        self._example, self._title = example, title
        self.setVisible(example is not None)
        self.insert.setVisible(self.can_insert)
        if example is not None:
            # The example's blocks as sentences
            language = self._book().language
            clip = example.clip(language, language_code())
            blocks = (each for root in clip.roots for each in clip.project.within(root))
            definitions = language.of(clip.project).definitions
            steps = (block for block in blocks if not definitions[block.type].is_value)
            told = ". ".join(sentence(clip.project, language, block.id) for block in steps)
            self.insert.setAccessibleDescription(told)
            self.try_it.setAccessibleDescription(told)

    def take_focus(self) -> None:
        """Let the keyboard and the screen reader be at the first button."""
        first = self.insert if self.can_insert else self.try_it
        first.setFocus(Qt.FocusReason.OtherFocusReason)

    def dress(self, theme: Theme) -> None:
        """Take the theme and the size of the text."""
        side = self.fontMetrics().height()
        self.insert.setIcon(icon("plus", theme))
        self.try_it.setIcon(icon("play", theme.colour("accent_text")))
        for button in (self.insert, self.try_it):
            button.setIconSize(icon_room(side))

    def put_on_page(self) -> bool:
        """Put the example's blocks where there is room, each on the page where it belongs."""
        if self._example is None:
            return False
        canvas, made = self._canvas, list[str]()
        clips = {page: self._clip(self._example, page) for page in PAGES}
        if not canvas.attempt(lambda: made.extend(self._put_all(clips))) or not made:
            return False
        canvas.selection.set(made)
        canvas.show_block(made[0])
        told = sentence(canvas.editor.project, canvas.editor.language, made[0])
        canvas.news.announced.emit(tr("added: {block}", block=told))
        return True

    def ask_to_try(self) -> None:
        """Ask to run the example as a project of its own."""
        if self._example is not None:
            language = self._book().language
            project = self._example.project(language, language_code(), self._title)
            arrange(project, language, self._canvas.look.measures)
            self.try_requested.emit(project)

    def _clip(self, example: Example, page: str) -> Clip:
        clip = example.clip(self._book().language, language_code(), page)
        arrange(clip.project, self._book().language, self._canvas.look.measures)
        return clip

    def _put_all(self, clips: Mapping[str, Clip]) -> list[str]:
        """Put the blocks of each page on it, in one step; gives those of the last page."""
        made: list[str] = []
        history = self._canvas.editor.history
        with history.as_own(), history.transaction("add blocks"):
            for page, clip in clips.items():
                if clip.stacks:
                    made = list(self._put(clip, page))
        return made

    def _put(self, clip: Clip, page: str) -> tuple[str, ...]:
        canvas = self._canvas
        if canvas.editor.project.kind_of_page(canvas.page) != page:
            canvas.show_page(page)
        where = free_place(canvas, clip)
        return paste(canvas.editor, clip, canvas.page, where.x(), where.y())
