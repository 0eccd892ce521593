"""Words of lists in seven languages: of headers, by what the column holds; and of cells. Data alone."""

# ruff: noqa: E501, RUF001 - rows of a table; signs and words of other alphabets are meant

HEADERS: dict[str, dict[str, str]] = {
    "en": {
        "name": "name, object, title, item, object name, designation",
        "width": "width, w", "depth": "depth, d, thickness", "height": "height, h", "length": "length, l",
        "diameter": "diameter, dia, diam, ø",
        "base": "base", "base_width": "base width, width of base", "base_depth": "base depth, depth of base",
        "base_diameter": "base diameter, diameter of base",
        "pedestal": "pedestal diameter, diameter of pedestal, plinth diameter, diameter of plinth, ø pedestal, ø plinth, pedestal ø, "
        "plinth ø",
        "centre_of_mass_height": "centre of mass height, centre of gravity, com height, height of centre of mass",
        "weight": "weight, mass", "count": "count, quantity, qty, pieces, pcs",
        "note": "note, notes, remark, remarks, comment, comments", "friction": "friction, friction coefficient",
        "body_file": "body file, scan file", "units": "units, unit", "shape": "shape, plan shape",
        "consequence": "consequence, consequences, severity, importance, risk, risk level", "photo": "photo, picture, image, photograph",
        "size": "size, sizes, dimensions, measurements", "number": "inventory number, inventory no, accession number",
    },
    "de": {
        "name": "objekt, name, titel, bezeichnung, gegenstand, objektname, objektbezeichnung, benennung",
        "width": "breite, b, maß b, gesamtbreite", "depth": "tiefe, t, maß t, dicke, stärke, gesamttiefe",
        "height": "höhe, h, maß h, gesamthöhe", "length": "länge, l, maß l", "diameter": "durchmesser, durchm, dm, ø",
        "base": "basis, standfläche", "base_width": "basisbreite, standbreite, fußbreite, breite der basis, breite basis",
        "base_depth": "basistiefe, standtiefe, fußtiefe, tiefe der basis, tiefe basis",
        "base_diameter": "basisdurchmesser, standdurchmesser, fußdurchmesser, durchmesser der basis, durchmesser basis, "
        "ø basis, ø fuß",
        "pedestal": "sockeldurchmesser, sockel durchmesser, durchmesser sockel, durchmesser des sockels, ø sockel, sockel ø",
        "centre_of_mass_height": "schwerpunkthöhe, schwerpunkt, höhe des schwerpunkts, höhe schwerpunkt",
        "weight": "gewicht, masse", "count": "anzahl, stück, stückzahl, stk, menge",
        "note": "bemerkung, bemerkungen, anmerkung, anmerkungen, notiz, notizen, hinweis, kommentar",
        "friction": "reibung, reibungszahl, reibungskoeffizient, reibungsbeiwert", "body_file": "körperdatei, scan",
        "units": "einheit, einheiten", "shape": "form, grundform, grundriss",
        "consequence": "folge, folgen, folgen bei sturz, folgen eines sturzes, konsequenz, konsequenzen, schadensfolge, "
        "schadensfolgen, schadensausmaß, bedeutung, wichtigkeit, risiko, risikoklasse, risikostufe",
        "photo": "foto, bild, abbildung, fotodatei, bilddatei", "size": "maße, abmessungen, abmessung, größe",
        "number": "inventarnummer, inventarnr, inventar nr, inv nr, objektnummer",
    },
    "it": {
        "name": "oggetto, nome, titolo, denominazione, opera, bene",
        "width": "larghezza, largo, largh", "depth": "profondità, prof, p, spessore", "height": "altezza, alt, h",
        "length": "lunghezza, lungh", "diameter": "diametro, diam, ø",
        "base": "base", "base_width": "larghezza base, larghezza della base",
        "base_depth": "profondità base, profondità della base", "base_diameter": "diametro base, diametro della base",
        "pedestal": "diametro piedistallo, diametro del piedistallo, diametro zoccolo, diametro dello zoccolo, ø zoccolo, "
        "ø piedistallo",
        "centre_of_mass_height": "altezza baricentro, altezza del baricentro, baricentro",
        "weight": "peso, massa", "count": "quantità, numero pezzi, pezzi, esemplari",
        "note": "nota, note, osservazioni, commento", "friction": "attrito, coefficiente di attrito",
        "body_file": "file del corpo", "units": "unità", "shape": "forma, pianta",
        "consequence": "conseguenza, conseguenze, importanza, gravità, rischio", "photo": "foto, fotografia, immagine",
        "size": "dimensioni, misure", "number": "numero di inventario, numero inventario, n inventario, inventario",
    },
    "es": {
        "name": "objeto, nombre, título, denominación, pieza, obra",
        "width": "ancho, anchura", "depth": "profundidad, fondo, espesor, grosor", "height": "alto, altura",
        "length": "largo, longitud", "diameter": "diámetro, ø",
        "base": "base", "base_width": "ancho base, ancho de la base, anchura de la base",
        "base_depth": "profundidad de la base, fondo de la base", "base_diameter": "diámetro base, diámetro de la base",
        "pedestal": "diámetro pedestal, diámetro del pedestal, diámetro peana, diámetro de la peana, ø peana, ø pedestal",
        "centre_of_mass_height": "altura del centro de masa, altura del centro de gravedad, centro de gravedad",
        "weight": "peso, masa", "count": "cantidad, unidades, ejemplares, número de piezas",
        "note": "nota, notas, observaciones, comentario", "friction": "rozamiento, fricción, coeficiente de fricción",
        "body_file": "archivo del cuerpo", "units": "unidad", "shape": "forma, planta",
        "consequence": "consecuencia, consecuencias, importancia, gravedad, riesgo", "photo": "foto, fotografía, imagen",
        "size": "dimensiones, medidas, tamaño", "number": "número de inventario, n inventario",
    },
    "el": {
        "name": "αντικείμενο, όνομα, τίτλος, ονομασία, έκθεμα, περιγραφή",
        "width": "πλάτος", "depth": "βάθος, πάχος", "height": "ύψος", "length": "μήκος", "diameter": "διάμετρος, ø",
        "base": "βάση", "base_width": "πλάτος βάσης", "base_depth": "βάθος βάσης", "base_diameter": "διάμετρος βάσης",
        "centre_of_mass_height": "ύψος κέντρου βάρους, ύψος κέντρου μάζας, κέντρο βάρους",
        "weight": "βάρος, μάζα", "count": "πλήθος, ποσότητα, τεμάχια, αριθμός τεμαχίων",
        "note": "σημείωση, σημειώσεις, παρατηρήσεις, σχόλια", "friction": "τριβή, συντελεστής τριβής",
        "body_file": "αρχείο σώματος", "units": "μονάδα, μονάδες", "shape": "σχήμα, κάτοψη",
        "consequence": "συνέπεια, συνέπειες, σημασία, κίνδυνος", "photo": "φωτογραφία, εικόνα", "size": "διαστάσεις",
        "number": "αριθμός ευρετηρίου, αριθμός καταγραφής, αρ ευρετηρίου",
    },
    "zh": {
        "name": "名称, 名稱, 文物名称, 藏品名称, 物品, 器物, 对象",
        "width": "宽, 宽度, 寬, 寬度", "depth": "深, 深度, 进深, 厚, 厚度", "height": "高, 高度, 通高",
        "length": "长, 长度, 長, 長度", "diameter": "直径, 直徑, 口径, 腹径, 最大直径, ø",
        "base": "底座", "base_width": "底宽, 底座宽, 底座宽度", "base_depth": "底深, 底座深, 底座深度",
        "base_diameter": "底径, 底徑, 足径, 底座直径", "centre_of_mass_height": "重心高, 重心高度, 质心高度",
        "weight": "重量, 质量, 質量", "count": "数量, 數量, 件数", "note": "备注, 備註, 说明", "friction": "摩擦系数, 摩擦",
        "body_file": "模型文件", "units": "单位, 單位", "shape": "形状, 形狀, 器形", "consequence": "后果, 重要性, 级别, 风险, 風險",
        "photo": "照片, 图片, 圖片", "size": "尺寸, 规格", "number": "编号, 藏品编号, 登记号, 总登记号",
    },
    "tr": {
        "name": "nesne, eser, eser adı, ad, adı, isim, eşya, obje",
        "width": "genişlik, en", "depth": "derinlik, kalınlık", "height": "yükseklik", "length": "uzunluk, boy",
        "diameter": "çap, ø", "base": "taban, kaide", "base_width": "taban genişliği, kaide genişliği",
        "base_depth": "taban derinliği, kaide derinliği", "base_diameter": "taban çapı, kaide çapı",
        "centre_of_mass_height": "ağırlık merkezi yüksekliği, kütle merkezi yüksekliği, ağırlık merkezi",
        "weight": "ağırlık, kütle", "count": "adet, sayı, miktar", "note": "not, notlar, açıklama, açıklamalar",
        "friction": "sürtünme, sürtünme katsayısı", "body_file": "cisim dosyası", "units": "birim", "shape": "şekil, biçim",
        "consequence": "sonuç, önem, önem derecesi, risk", "photo": "fotoğraf, resim, görsel", "size": "boyutlar, ölçüler",
        "number": "envanter no, envanter numarası, eser no",
    },
}  # fmt: skip

TELLING = (
    "base, foot, feet, centre, gravity, mass, diameter, height, width, depth, weight, basis, sockel, schwerpunkt, fuß, "
    "baricentro, piede, gravedad, peana"
)
"""A column whose name has such a word, or one of a measure above, may decide the verdict."""

SIDES = {"h": "height", "b": "width", "w": "width", "t": "depth", "d": "depth", "p": "depth", "l": "length"}
"""Letters of measures such as 120 x 80 x 220 cm; ø and its like are diameters."""

UNITS = {
    "m": "m, meter, metre, metres, meters, metri, metro, metros, μ, μετρα, 米, 公尺, metre",
    "cm": "cm, centimetre, centimetres, centimeter, centimeters, zentimeter, centimetri, centimetros, εκ, εκατοστα, "
    "厘米, 公分, santimetre, santim",
    "mm": "mm, millimetre, millimetres, millimeter, millimeters, millimetri, milimetros, χιλιοστα, 毫米, milimetre",
    "ft": "ft, foot, feet, fuß, piedi, pies", "in": "in, inch, inches, zoll, pollici, pulgadas, 英寸, inç",
    "kg": "kg, kgs, kilo, kilogram, kilograms, kilogramm, kilogrammo, kilogrammi, kilogramo, kilogramos, κιλα, "
    "κιλο, 公斤, 千克, kilogram",
    "g": "g, gr, gram, grams, gramm, grammi, gramos, γρ, 克", "t": "t, tonne, tonnes, tonnen, tonnellate, toneladas, 吨",
    "lb": "lb, lbs, pound, pounds, libbre, libras",
}  # fmt: skip

ABOUT = (
    "ca, circa, c, etwa, ungefähr, ungef, zirka, rund, about, approx, approximately, around, roughly, aprox, "
    "aproximadamente, unos, περίπου, 约, 約, 大约, yaklaşık, cca, max, maximal, maximum, massimo, máx, máximo, höchstens, "
    "min, minimal, minimum, mindestens, at most, at least, möglicherweise, wohl, vermutlich, probably, forse, rekonstruiert"
)
UNKNOWN = (
    "n a, na, k a, ka, keine angabe, unbekannt, unklar, fehlt, nicht gemessen, nicht messbar, offen, tbd, unknown, "
    "missing, none, not known, not measured, sconosciuto, sconosciuta, ignoto, n d, nd, non misurato, desconocido, "
    "s d, no medido, άγνωστο, άγνωστος, 未知, 不详, 无, bilinmiyor, yok, ölçülmedi, x, xx, xxx"
)
TOTALS = (
    "sum, total, totals, grand total, summe, gesamt, gesamtsumme, insgesamt, totale, somma, suma, σύνολο, άθροισμα, "
    "合计, 总计, 共计, toplam"
)
WITH = (
    "mit, ohne, inkl, inklusive, einschl, einschließlich, samt, with, without, incl, including, excl, con, senza, compreso, "
    "compresa, sin, incluido, incluida, με, χωρίς"
)
"""After a measure: how it was taken."""
PAIRS = "paar, ein paar, pair, a pair, paio, un paio, coppia, par, un par, ζεύγος, ζευγάρι, 一对, çift"

SHAPES = {
    "round": "round, circular, circle, cylinder, cylindrical, rund, kreisrund, kreisförmig, zylinder, zylindrisch, rundsockel, "
    "tondo, tonda, rotondo, rotonda, circolare, cilindrico, cilindrica, cilindro, redondo, redonda, cilíndrico, στρογγυλό, "
    "στρογγυλός, κυκλικό, κυλινδρικό, 圆, 圓, 圆形, 圆柱, yuvarlak, dairesel, silindir, silindirik, "
    "oval, ovale, ellipse, elliptic, elliptical, elliptisch, ellittico, ellittica, elíptico, ovalado, ovalada, ωοειδές, οβάλ, "
    "ελλειπτικό, 椭圆, 橢圓, 椭圆形, eliptik",
    "box": "box, rectangular, rectangle, square, eckig, rechteckig, rechteck, viereckig, quadratisch, quader, quaderförmig, kasten, "
    "rettangolare, quadrato, quadrata, rectangular, cuadrado, cuadrada, ορθογώνιο, τετράγωνο, 方, 方形, 矩形, 长方形, "
    "dikdörtgen, kare",
    "triangle": "triangular, triangle, dreieckig, dreieck, triangolare, triangolo, triángulo, τριγωνικό, τρίγωνο, 三角, 三角形, üçgen",
    "polygon": "polygonal, polygon, vieleckig, poligonale, poligonal, πολυγωνικό, 多边形, çokgen, "
    "pentagonal, pentagon, fünfeckig, fünfeck, pentagonale, πενταγωνικό, 五角形, beşgen, "
    "hexagonal, hexagon, sechseckig, sechseck, sechskant, esagonale, esagono, hexágono, εξαγωνικό, 六角形, 六边形, altıgen, "
    "octagonal, octagon, achteckig, achteck, achtkant, ottagonale, ottagono, octogonal, οκταγωνικό, 八角形, 八边形, sekizgen",
}
"""Outlines from above: round ones are circles and ellipses, polygons regular ones of five sides or more."""
CONSEQUENCES = {
    "low": "low, minor, small, gering, niedrig, klein, leicht, basso, bassa, lieve, bajo, baja, leve, χαμηλή, μικρή, "
    "低, 小, 轻, düşük, az",
    "medium": "medium, moderate, middle, mittel, mäßig, medio, media, μεσαία, μέτρια, 中, 中等, orta",
    "high": "high, major, severe, hoch, groß, schwer, sehr hoch, very high, alto, alta, grave, elevato, elevata, υψηλή, "
    "μεγάλη, σοβαρή, 高, 大, 严重, yüksek, ağır",
}
