"""The grammars of PDF pages, of the structure of a PDF, and of Illustrator's own text."""

from growing import Grammar

_SHARED: Grammar = {
    "n": ["1 ", "0 ", "-2.5 ", ".5 ", "1e3 ", "100000000000 ", "1{digit*} ", "--1 ", "1.2.3 "],
    "digit": ["0", "9", "."],
    "blank": [" ", "\n", "\r\n", "\x00", "\t"],
    "name": ["a", "X0", "X§", "X¤", "A", "B", "T", "#41", "{letter*}"],
    "letter": ["a", "b§", "#20"],
    "string": ["(a)", "({inside*})", "<41>", "<{hex*}>", "({inside*}", "<{hex*}"],
    "inside": ["a", "(", ")", "\\(", "\\051", "\\\n", "{blank*}"],
    "hex": ["4", " ", "f0", "x"],
    "path": [
        "0 0 m 1 1 l ",
        "{n}{n}m ",
        "{n}{n}l ",
        "{n}{n}{n}{n}{n}{n}c ",
        "{n}{n}{n}{n}v ",
        "{n}{n}{n}{n}y ",
        "h ",
        "l ",
        "{n*}l ",
    ],
    "paint": ["S ", "f ", "B ", "b* ", "n ", "s ", "F ", "f* "],
    "junk": [
        "x ",
        "foo§ ",
        "{n*}",
        "{string}",
        "[{n*}] ",
        "[",
        "]",
        "{blank*}",
        "% {letter*}\n",
        "/{name} ",
        "<<",
        ">>",
    ],
}
_CONTENT: Grammar = {
    "file": ["{content*}", "{content*}{section*}", "/X0 Do {section*}", "{content*}{own}"],
    "section": [
        "\f{content*}",
        "\f/X¤ Do /X¤ Do ",
        "\f/X¤ Do {content*}",
        "\f{options}\v{content*}",
        "\f{options}\v/X¤ Do ",
    ],
    "options": [
        "",
        "/Matrix[1 0 0 1 {n}{n}]",
        "/Matrix[{n*}]",
        "/BBox[0 0 1 1]",
        "/BBox[{n}{n}{n}{n}]",
        "/OC 5 0 R",
        "/OC<</Type/OCMD/OCGs[{group*}]/VE{rule}>>",
        "/Group<</S/Transparency>>",
        "/PatternType 1/Subtype/None",
        "/Resources<</XObject<<>>>>",
        "/{name} {rule}",
    ],
    "group": ["5 0 R "],
    "rule": ["5 0 R", "[/Not 5 0 R]", "[/And {rule} {group*}]", "[/Or {rule*}]", "[{rule*}]"],
    "own": ["\f%own\v{line*}"],
    "content": [
        "0 0 1 1 re f ",
        "{path*}{paint}",
        "{path*}W n {content*}",
        "0 0 {n}{n}re W* n ",
        "q {content*}Q ",
        "q ",
        "Q ",
        "{n}{n}{n}{n}{n}{n}cm ",
        "1 0 0 1 1 1 cm ",
        "/X0 Do ",
        "/{name} Do ",
        "/OC /A BDC {content*}EMC ",
        "/OC /B BDC ",
        "/{name} BMC ",
        "/OC <</Type/OCMD/VE{rule}>> BDC ",
        "EMC ",
        "BI /W 1 ID {inside*} EI ",
        "BI {blank*}",
        "BI EI ",
        "ID ",
        "BT {text*}ET ",
        "{n}{n}{n}rg ",
        "/Pattern cs /X0 scn ",
        "/P cs {n}{n}{n}/T scn ",
        "/{name} cs ",
        "/S gs ",
        "/M gs ",
        "/{name} gs ",
        "/{name} sh ",
        "{n}w ",
        "[{n*}] 0 d ",
        "{junk*}",
    ],
    "text": ["{string}Tj ", "[{string*}] TJ ", "/F 1 Tf "],
}
_LINES: Grammar = {
    "line": [
        "0 0 m 1 1 l S\n",
        "{path*}{mark}\n",
        "{path*}W n\n",
        "u\n{line*}U\n",
        "*u\n{line*}*U\n",
        "q\n{line*}Q\n",
        "u\n",
        "U\n",
        "{flag*}Lb\n(a§) Ln\n{line*}LB\n",
        "({inside*}) Ln\n",
        "0 A\n1 Ap\n0 Xw\n",
        "%AI5_Begin{block}\n{line*}%AI5_End{block}\n",
        "%%Begin{block}: {letter*}\n",
        "%%End{block}\n",
        "%_{letter*}\n",
        "%_{letter*},\n",
        "%_/XMLUID : (a{letter*}) ;\n",
        "%_({inside*}) /UnicodeString (AIArtName) ,\n",
        "%%BeginData: {n}{word} Bytes\n{letter*}\n%%EndData\n",
        "%%BeginData: 1{digit*}\n",
        "({inside*}) XT\n",
        "/{name} «{procedure*}» def\n",
        "/m «{procedure*}» def\n",
        "{n}{n}translate\n",
        "[{n}{n}{n}{n}{n}{n}] concat\n",
        "({inside*}) {n} Xx\n",
        "0 To\n{line*}TO\n",
        "/{name} :\n{line*};\n",
        "({inside*}) Bn\nBb\n{n*}Bg\n0 BB\n",
        "{n*}XR\n",
        "%%Page: {n}{n}\n",
        "%%PageTrailer\n",
        "%AI3_Note: {letter*}\n",
        "{n}{n}{n}{n}k\n",
        "{n}{n}{n}Xa\n",
        "{junk*}\n",
        "{blank*}",
        "{line}{line*}",
    ],
    "word": ["Hex", "Binary", "ASCII"],
    "flag": ["1 ", "0 ", "{n}"],
    "mark": ["S", "f", "N", "b", "{letter*}"],
    "block": ["Pattern", "Gradient", "Raster", "ProcSet", "Resource", "Document", "Setup", "Palette", "PluginObject"],
    "procedure": ["moveto ", "bind ", "({inside*})", "%{letter*}\n", "/{name} ", "«{procedure*}»", "{junk}", "«", "»"],
}
PDF: Grammar = _SHARED | _LINES | _CONTENT
ILLUSTRATOR: Grammar = (
    _SHARED
    | _LINES
    | {
        "file": [
            "%!PS-Adobe-3.0\n%%Creator: Adobe Illustrator(R) 8.0\n%%EndComments\n{line*}%%EndSetup\n{line*}",
            "%!PS-Adobe-3.0 EPSF-3.0\n%%Creator: Adobe Illustrator(R) 8.0\n{line*}",
            "0 0 m 1 1 l S\n{line*}",
            "%!PS\n{line*}0 0 m 1 1 l stroke\n",
            "%!PS-Adobe-3.0\n{line*}%%EndProlog\n{line*}",
        ]
    }
)
STRUCTURE: Grammar = _SHARED | {
    "file": [
        "%PDF-1.5\n{catalogue}{object*}trailer<</Root 1 0 R>>",
        "%PDF-1.5\n{object*}{catalogue}{tail}",
        "%PDF-1.5\n{catalogue}{object*}{tail}",
    ],
    "tail": [
        "trailer<</Root 1 0 R>>",
        "xref\n0 1\n{entry*}trailer<</Root 1 0 R/Size 9/Prev {n}>>",
        "startxref {n}%%EOF",
    ],
    "entry": ["0000000000 65535 f \n", "000000001§ 00000 n \n", "{n}{n}n\n"],
    "catalogue": [
        "1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj 2 0 obj<</Kids[{kid*}3 0 R]/Count 1>>endobj "
        "3 0 obj<</Type/Page/Contents[{kid*}4 0 R]>>endobj "
        "4 0 obj<</Length 13>>stream\n0 0 1 1 re f \nendstream endobj ",
        "1 0 obj<</Pages 9 0 R/OCProperties<</D<</OFF[{kid*}]/ON[{kid*}]>>>>>>endobj "
        "9 0 obj<</Kids[10 0 R 10 0 R]>>endobj ",
    ],
    "kid": ["3 0 R ", "4 0 R ", "{n}", "null ", "<</Kids[{kid*}]>>", "1§ 0 R ", "1¤ 0 R "],
    "object": [
        "9 0 obj {value}endobj ",
        "1§ 0 obj<</Kids[1¤ 0 R 1¤ 0 R]>>endobj ",
        "1§ 0 obj<</{name} {value}/Length {n}>>stream\n{letter*}\nendstream endobj ",
        "8 0 obj<</Type/ObjStm/N {n}/First {n}/Length 10/Filter{filter}>>stream\n{hex*}\nendstream endobj ",
        "8 0 obj<</Type/XRef/W[1 2 1]/Index[{n*}]/Size {n}/Length 1>>stream\n{letter*}endstream endobj ",
        "{n}0 obj {blank*}",
        "% {letter*}\n",
        "obj ",
        "{n}{n}obj<<",
        "endstream ",
        "{junk*}",
    ],
    "filter": ["/FlateDecode", "[{filter*}]", "/LZWDecode", "/ASCIIHexDecode", "/Fl", "/{name}"],
    "value": ["1 ", "<<{pair*}>>", "[{value*}]", "{string}", "{n}0 R ", "/{name} ", "null ", "true "],
    "pair": ["/a 1", "/{name} {value}", "/N 1", "/First 1", "/{name} {kid}", "%{letter*}\n"],
}

_FIXED = {
    3: b"<</Type/Page/Parent 2 0 R/MediaBox[0 0 9 9]/Contents 4 0 R/Resources 6 0 R%s>>",
    5: b"<</Type/OCG/Name(Layer)>>",
}


def page_of(text: str) -> bytes:
    """Make a PDF: its page's content, then behind form feeds forms X0, X1, ..., each with options before a \\v."""
    content, *forms = text.encode("utf-8", "replace").split(b"\f")
    own = b""
    objects: dict[int, bytes] = {4: _stream(b"", content), 5: _FIXED[5]}
    names = []
    for index, form in enumerate(forms):
        options, mark, rest = form.partition(b"\v")
        if options == b"%own":
            own = b"/PieceInfo<</Illustrator<</Private<</AIPrivateData1 %d 0 R>>>>>>" % (20 + index)
            options = b""
        head = b"/Subtype/Form/Resources 6 0 R" if b"Resources" not in options else b"/Subtype/Form"
        objects[20 + index] = _stream(head + options, rest if mark else form)
        names.append(b"/X%d %d 0 R" % (index, 20 + index))
    objects[1] = b"<</Type/Catalog/Pages 2 0 R/OCProperties<</OCGs[5 0 R]/D<</OFF[5 0 R]>>>>>>"
    objects[2] = b"<</Type/Pages/Kids[3 0 R]/Count 1>>"
    objects[3] = _FIXED[3] % own
    states = b"/ExtGState<</S<</ca 0/LW 2>>/M<</SMask<</S/Alpha/G 20 0 R>>>>>>"
    patterns = b"/Pattern<</T 7 0 R/X0 20 0 R>>/ColorSpace<</P[/Pattern/DeviceRGB]>>"
    properties = b"/Properties<</A 5 0 R/B 8 0 R>>"
    objects[6] = b"<</XObject<<" + b"".join(names) + b">>" + states + patterns + properties + b">>"
    objects[7] = _stream(b"/PatternType 1/Resources<<>>", b"0 0 1 1 re f")
    objects[8] = b"<</Type/OCMD/VE[/Not 5 0 R]>>"
    return _file(objects)


def _stream(options: bytes, data: bytes) -> bytes:
    return b"<<%s/Length %d>>stream\n%s\nendstream" % (options, len(data), data)


def _file(objects: dict[int, bytes]) -> bytes:
    """Write objects with a table of their places."""
    out, places = b"%PDF-1.5\n", {}
    pieces = [out]
    size = len(out)
    for number, body in sorted(objects.items()):
        places[number] = size
        pieces.append(b"%d 0 obj\n%s\nendobj\n" % (number, body))
        size += len(pieces[-1])
    last = max(objects)
    rows = [b"%010d 00000 n \n" % places[one] if one in places else b"0000000000 65535 f \n" for one in range(last + 1)]
    pieces += [b"xref\n0 %d\n" % (last + 1), *rows, b"trailer<</Root 1 0 R/Size %d>>\nstartxref\n" % (last + 1)]
    return b"".join([*pieces, b"%d\n%%%%EOF\n" % size])
