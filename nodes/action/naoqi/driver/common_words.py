"""Words that people often answer with, for questions that may be answered with anything.

A NAO understands only words that it was told before.
"""

from __future__ import annotations

WORDS = {
    "en": "yes, no, maybe, okay, hello, goodbye, please, thank you, sorry, stop, help, again, "
    "good, bad, happy, sad, tired, fine, left, right, red, green, blue, yellow, white, black, one, "
    "two, three, four, five, six, seven, eight, nine, ten, robot, music, dance, sit down, stand up",
    "de": "ja, nein, vielleicht, okay, hallo, tschüss, bitte, danke, entschuldigung, stopp, hilfe, "
    "noch einmal, gut, schlecht, froh, traurig, müde, links, rechts, rot, grün, blau, gelb, weiß, "
    "schwarz, eins, zwei, drei, vier, fünf, sechs, sieben, acht, neun, zehn, Roboter, Musik",
    "es": "sí, no, quizás, vale, hola, adiós, por favor, gracias, perdón, para, ayuda, otra vez, "
    "bien, mal, contento, triste, cansado, izquierda, derecha, rojo, verde, azul, amarillo, "
    "blanco, negro, uno, dos, tres, cuatro, cinco, seis, siete, ocho, nueve, diez, robot",
    "fr": "oui, non, peut-être, d'accord, bonjour, au revoir, s'il te plaît, merci, pardon, stop, "
    "aide, encore, bien, mal, content, triste, fatigué, gauche, droite, rouge, vert, bleu, jaune, "
    "blanc, noir, un, deux, trois, quatre, cinq, six, sept, huit, neuf, dix, robot, musique",
    "it": "sì, no, forse, va bene, ciao, arrivederci, per favore, grazie, scusa, fermo, aiuto, "
    "ancora, bene, male, contento, triste, stanco, sinistra, destra, rosso, verde, blu, giallo, "
    "bianco, nero, uno, due, tre, quattro, cinque, sei, sette, otto, nove, dieci, robot, musica",
    "ja": "はい, いいえ, たぶん, こんにちは, さようなら, お願いします, ありがとう, ごめんなさい, "
    "止まって, 助けて, もう一度, いい, わるい, うれしい, かなしい, 左, 右, 赤, 緑, 青, 黄色, 白, "
    "黒, 一, 二, 三, 四, 五, 六, 七, 八, 九, 十, ロボット, 音楽, 踊って",
}
"""By our word for the language."""


def common_words(language: str) -> tuple[str, ...]:
    """Return common answers in a language, in English where we have none."""
    return tuple(WORDS.get(language, WORDS["en"]).split(", "))
