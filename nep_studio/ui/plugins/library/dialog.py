"""The dialog in which a person chooses own blocks to share, and says what others should know."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

from msgspec.structs import replace
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QGroupBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPlainTextEdit,
    QWidget,
)

from faults.files import as_file_name
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import ChangeProcedure
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.operations.packing import mark, packed
from nep_studio.blocks.packs import ENDING, LONGEST_LINE, About, Pack
from nep_studio.blocks.procedures import LONGEST_HELP, title, with_ids, with_names
from nep_studio.blocks.program import LANGUAGES, Procedure
from nep_studio.project.library import Library, write_pack
from nep_studio.settings import Settings
from nep_studio.ui.canvas.fields.field_edit import ReasonBubble
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.forms import fit_on_screen, hint, label_of
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import available_languages, tr

OWN = Qt.ItemDataRole.UserRole


class BlockForm(QGroupBox):
    """What is told of one own block: what it does, and its sentence in other languages."""

    def __init__(self) -> None:
        super().__init__()
        self.help = QPlainTextEdit(tabChangesFocus=True)
        self.help.setPlaceholderText(tr("What it does, for who finds it in the palette"))
        self.help.setMinimumHeight(self.fontMetrics().height() * 4)
        self.lines: dict[str, QLineEdit] = {}
        form = QFormLayout()
        form.setVerticalSpacing(self.fontMetrics().height() // 3)
        names = available_languages()
        for code in LANGUAGES:
            line = self.lines[code] = QLineEdit()
            line.setAccessibleName(names.get(code, code))
            form.addRow(QLabel(names.get(code, code)), line)
        self.note = hint("Its sentence in other languages can stay empty. Values stand in braces.")
        in_column(
            label_of("What this block does", self.help), (self.help, 1), form, self.note, of=self
        )

    def show_block(self, procedure: Procedure) -> None:
        """Show what is known of a block."""
        self.setTitle(title(procedure).replace("&", "&&"))
        self.help.setPlainText(procedure.help)
        names = " ".join(
            part if isinstance(part, str) else "{" + part.name + "}" for part in procedure.parts
        )
        for code, line in self.lines.items():
            line.setPlaceholderText(names)
            line.setText(with_names(procedure, procedure.sentences.get(code, "")))

    def told(self, procedure: Procedure) -> Procedure:
        """The block with what is told of it now."""
        written = {code: with_ids(procedure, line.text()) for code, line in self.lines.items()}
        others = {c: said for c, said in procedure.sentences.items() if c not in written}
        sentences = {**others, **{code: said for code, said in written.items() if said}}
        help_text = self.help.toPlainText().strip()[:LONGEST_HELP]
        return replace(procedure, help=help_text, sentences=sentences)


class ShareDialog(QDialog):
    """Makes a pack of own blocks of a project; ``shared`` gives it and its file."""

    shared = Signal(object, object)

    def __init__(
        self,
        editor: Editor,
        library: Library,
        settings: Settings,
        theme: Theme,
        own: str,
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Share blocks"))
        self._editor, self._library, self._settings = editor, library, settings
        self._told = dict(editor.project.procedures)
        """The own blocks with what is told of them by now."""
        self._shown = ""
        self.list = QListWidget()
        self.list.setAccessibleName(tr("Blocks to share"))
        self.list.setSpacing(self.fontMetrics().height() // 5)
        self.form = BlockForm()
        self.which = QComboBox()
        self.name, self.author, self.licence = QLineEdit(), QLineEdit(), QLineEdit()
        self.licence.setPlaceholderText("CC BY 4.0")
        self.reason = ReasonBubble(theme, self)
        self._fill(own)
        self._arrange()
        self.list.setFocus()

    def _fill(self, chosen: str) -> None:
        for own, procedure in self._told.items():
            item = QListWidgetItem(title(procedure))
            item.setData(OWN, own)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            is_chosen = own == chosen or not chosen
            item.setCheckState(Qt.CheckState.Checked if is_chosen else Qt.CheckState.Unchecked)
            self.list.addItem(item)
        for line in (self.author, self.licence):
            line.setMaxLength(LONGEST_LINE)
        self.author.setText(self._settings.author)
        self.licence.setText(self._settings.licence)
        self.name.setText(self._editor.project.name)
        for pack in self._packs():
            version = pack.about.version + 1
            words = tr("Version {version} of “{title}”", version=version, title=pack.title)
            self.which.addItem(words, pack.about.id)
        self.which.addItem(tr("A new pack, version 1"), "")
        self._on_pack_chosen()
        self.which.currentIndexChanged.connect(self._on_pack_chosen)
        self.list.currentItemChanged.connect(lambda now, _before: self._show(now))
        first = list(self._told).index(chosen) if chosen in self._told else 0
        self.list.setCurrentRow(first)

    def _packs(self) -> list[Pack]:
        """The packs of which these blocks can be a new version."""
        origins = [own.origin for own in self._told.values() if own.origin is not None]
        ids = dict.fromkeys(origin.pack for origin in origins)
        found = (self._library.pack(pack, self._editor.language) for pack in ids)
        return [pack for pack in found if pack is not None]

    def _arrange(self) -> None:
        about = QFormLayout()
        about.addRow(label_of("Share as", self.which), self.which)
        about.addRow(label_of("Title", self.name), self.name)
        about.addRow(label_of("Author", self.author), self.author)
        about.addRow(label_of("Licence", self.licence), self.licence)
        standard = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(standard.Save | standard.Cancel)
        self.buttons.button(standard.Save).setText(tr("Share…"))
        self.buttons.button(standard.Cancel).setText(tr("Cancel"))
        self.buttons.accepted.connect(self.ask_for_file)
        self.buttons.rejected.connect(self.reject)
        what = hint("Blocks that these need come along by themselves.")
        left = in_column((self.list, 1), what)
        right = in_column(about, (self.form, 1))
        in_column((in_row((left, 2), (right, 3)), 1), self.reason, self.buttons, of=self)
        fit_on_screen(self, 48, 36)

    def _show(self, item: QListWidgetItem | None) -> None:
        self._take_told()
        if item is not None:
            self._shown = str(item.data(OWN))
            self.form.show_block(self._told[self._shown])

    def _take_told(self) -> None:
        if self._shown:
            self._told[self._shown] = self.form.told(self._told[self._shown])

    def _on_pack_chosen(self) -> None:
        pack = self._chosen_pack()
        if pack is not None:
            self.name.setText(pack.title)
            self.author.setText(pack.about.author)
            self.licence.setText(pack.about.licence)

    def _chosen_pack(self) -> Pack | None:
        pack_id = str(self.which.currentData())
        return self._library.pack(pack_id, self._editor.language) if pack_id else None

    @property
    def chosen(self) -> list[str]:
        """The own blocks that are ticked."""
        items = (self.list.item(row) for row in range(self.list.count()))
        return [str(one.data(OWN)) for one in items if one.checkState() == Qt.CheckState.Checked]

    def ask_for_file(self) -> None:
        """Ask where the pack is to be, when there is something in it."""
        self._take_told()
        if not self.chosen:
            self._tell(tr("Tick at least one block."))
            return
        if not self.name.text().strip():
            self._tell(tr("A pack needs a title."))
            return
        name = as_file_name(self.name.text()) or "blocks"
        suggested = self._settings.last_folder / f"{name}{ENDING}"
        kinds = (tr("Block packs") + f" (*{ENDING})",)
        ask_for_path(self, tr("Share blocks"), suggested, self.share, "save", kinds)

    def share(self, path: Path) -> None:
        """Write the pack, put it into the library, and note it in the project, as one step."""
        self._take_told()
        path, editor = path if path.suffix else path.with_suffix(ENDING), self._editor
        try:
            with editor.transaction("share own blocks"):
                for own, told in self._told.items():
                    if told != editor.project.procedures.get(own):
                        editor.apply(ChangeProcedure(told))
                pack = packed(
                    editor.project, editor.language, self.chosen, self._about(), self.name.text()
                )
                mark(editor, pack, self.chosen)
                write_pack(pack, path)
                self._library.keep(pack, editor.language)
        except BlocksError as error:
            self._tell(" ".join([tr(error.sentence), *map(tr, error.checklist)]))
            return
        self._settings.author, self._settings.licence = pack.about.author, pack.about.licence
        self.shared.emit(pack, path)
        self.accept()

    def _about(self) -> About:
        before = self._chosen_pack()
        author, licence = self.author.text().strip(), self.licence.text().strip()
        if before is None:
            return About(uuid4().hex, 1, author, licence)
        return About(before.about.id, before.about.version + 1, author, licence)

    def _tell(self, words: str) -> None:
        self.reason.tell(words)
