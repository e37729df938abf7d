"""Makes the template of the QGIS project that a build writes beside its GeoPackage: qgis_project.qgs, in this folder.

    blockrand build samples/blockrand-viertel.osm -o out/sample --formats gpkg
    QT_QPA_PLATFORM=offscreen /usr/bin/python3 pipeline/outputs/geopackage/qgis_project.py out/sample/buildings.gpkg [TARGET]

Needs QGIS 3.22 or newer with its Python (Debian: python3-qgis). Run it after a change of LAYERS below, commit what it writes.
readers_test.py tells when the two differ.

QGIS itself writes the project; then everything goes that differs between builds or that QGIS has as a default. Marks stand for
what a build fills in: {{crs}}, {{extent}}, {{data}} and {{style TABLE/STYLE}}. Colours and labels are in qgis_styles.cpp alone.
"""
import os
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

from qgis.core import (QgsApplication, QgsCoordinateReferenceSystem, QgsProject, QgsProjectMetadata, QgsVectorLayer)

FOLDER = os.path.dirname(os.path.abspath(__file__))
ATTRIBUTION = '\u00a9 OpenStreetMap contributors, ODbL 1.0'

# What people see when they point at a house.
HOUSE = ('<b>[% coalesce("address", "name", "id") %]</b><br>[% "use" %], [% round("storeys") %] storeys, [% round("height", 1) %] m'
         '<br>[% "style" %] [% round(100 * "style_confidence") %] %, [% coalesce("construction_date", "era") %]')
BODY = '<b>[% "id" %]</b><br>[% "built_roof" %], [% round("storeys") %] storeys, [% round("height", 1) %] m'

# The panel from top to bottom, which is also what covers what: (name, table, style, shown) or (group, one at a time, [layers]).
LAYERS = [
    ('Not modelled, and why', 'reported', 'Reasons', False),
    ('What walls face', 'facade_edges', 'Kinds', False),
    ('Buildings, coloured by', True, [
        ('Storeys', 'buildings', 'Storeys', True),
        ('Style', 'buildings', 'Style', False),
        ('Confidence of the style', 'buildings', 'Confidence of the style', False),
        ('Era', 'buildings', 'Era', False),
        ('Roof', 'buildings', 'Roofs', False),
        ('Position to the neighbours', 'buildings', 'Position', False),
        ('Source of the storeys', 'buildings', 'Source of the storeys', False)]),
    ('Bodies of the buildings, coloured by', True, [
        ('Roof of each body', 'parts', 'Roofs', False),
        ('Level of detail', 'parts', 'Level of detail', False),
        ('Faces in space (for 3D map views)', 'surfaces', 'Classes', False)]),
    ('Courtyards', 'courtyards', 'Closed and open', False),
    ('Blocks, coloured by', True, [
        ('Floor area ratio', 'blocks', 'Floor area ratio', False),
        ('Built share of the street front', 'blocks', 'Closure', False)]),
    ('Squares of a grid, coloured by', True, [
        ('Built share', 'cells', 'Built share', False),
        ('Mean of the mapped storeys', 'cells', 'Storeys', False)]),
    ('Tiles', 'tiles', 'Outlines', False),
]
DISPLAY = {'buildings': 'coalesce("address", "name", "id")', 'reported': '"id"', 'facade_edges': '"id"', 'parts': '"id"',
           'surfaces': '"body"', 'courtyards': '"id"', 'blocks': '"id"', 'cells': '"id"', 'tiles': '"id"'}
TIPS = {'buildings': HOUSE, 'parts': BODY}

# What is kept of what QGIS writes.
OF_PROJECT = ('title', 'projectCrs', 'layer-tree-group', 'projectlayers', 'properties', 'projectMetadata')
OF_LAYER = ('id', 'datasource', 'layername', 'srs', 'provider', 'previewExpression', 'mapTip')
OF_PROPERTIES = ('CopyrightLabel', 'Measurement', 'Paths', 'SpatialRefSys')


def identifier(table, style):
    return f'{table}_{style}'.lower().replace(' ', '_')


def put(project, group, entry, folder):
    """Adds a line of LAYERS to a group of the layer tree."""
    if isinstance(entry[1], bool):
        name, exclusive, members = entry
        child = group.addGroup(name)
        for member in members:
            put(project, child, member, folder)
        shown = [i for i, member in enumerate(members) if member[3]]
        child.setIsMutuallyExclusive(exclusive, shown[0] if shown else -1)
        child.setExpanded(bool(shown))
        child.setItemVisibilityChecked(True)  # else a layer that is ticked in it would stay hidden
        return
    name, table, style, shown = entry
    layer = QgsVectorLayer(os.path.join(folder, 'buildings.gpkg') + f'|layername={table}', name, 'ogr')
    assert layer.isValid(), table
    layer.setDisplayExpression(DISPLAY[table])
    layer.setMapTipTemplate(TIPS.get(table, ''))
    project.addMapLayer(layer, False)
    node = group.addLayer(layer)
    node.setItemVisibilityChecked(shown)
    node.setExpanded(shown)


def styles(entries):
    """[(name, table, style)] in the order of the panel."""
    found = []
    for entry in entries:
        found += styles(entry[2]) if isinstance(entry[1], bool) else [entry[:3]]
    return found


def mark(element, text):
    """Puts a mark in the place of all that an element holds."""
    element[:] = []
    element.text = '{{' + text + '}}'


def condensed(root):
    """What QGIS wrote without what differs from build to build."""
    for name in ('saveDateTime', 'saveUser', 'saveUserFull'):
        root.attrib.pop(name, None)
    root[:] = [child for child in root if child.tag in OF_PROJECT]
    mark(root.find('projectCrs'), 'crs')
    properties = root.find('properties')
    properties[:] = [child for child in properties if child.tag in OF_PROPERTIES]

    wanted = {(name, table): identifier(table, style) for name, table, style in styles(LAYERS)}
    ids, marks = {}, {}
    for layer in root.iter('maplayer'):
        table = layer.find('datasource').text.partition('layername=')[2]
        name = layer.find('layername').text
        ids[layer.find('id').text] = layer.find('id').text = wanted[name, table]
        style = next(s for n, t, s in styles(LAYERS) if (n, t) == (name, table))
        layer[:] = [child for child in layer if child.tag in OF_LAYER]
        kept = {key: layer.get(key) for key in ('type', 'geometry', 'wkbType', 'readOnly')}
        layer.attrib.clear()
        layer.attrib.update(kept)
        mark(layer.find('srs'), 'crs')
        layer[-1].tail = '\n' + f'{{{{style {table}/{style}}}}}'
    order = [identifier(table, style) for _, table, style in styles(LAYERS)]
    layers = root.find('projectlayers')
    layers[:] = sorted(layers, key=lambda layer: order.index(layer.find('id').text))
    for node in root.iter('layer-tree-layer'):
        node.set('id', ids[node.get('id')])
    for custom in root.iter('custom-order'):
        custom[:] = []

    metadata = root.find('projectMetadata')
    metadata[:] = [child for child in metadata if child.tag in ('title', 'abstract')]
    canvas = ElementTree.SubElement(root, 'mapcanvas', {'name': 'theMapCanvas', 'annotationsVisible': '1'})
    ElementTree.SubElement(canvas, 'units').text = 'meters'
    mark(ElementTree.SubElement(canvas, 'extent'), 'extent')
    ElementTree.SubElement(canvas, 'rotation').text = '0'
    mark(ElementTree.SubElement(canvas, 'destinationsrs'), 'crs')
    return root


def sorted_attributes(root):
    for element in root.iter():
        items = sorted(element.attrib.items())
        element.attrib.clear()
        element.attrib.update(items)


def main(geopackage, target):
    application = QgsApplication([], False)
    application.initQgis()
    project = QgsProject.instance()
    project.setCrs(QgsCoordinateReferenceSystem('EPSG:25832'))
    project.setEllipsoid('EPSG:7030')
    project.setTitle('Blockrand')
    project.writeEntryBool('CopyrightLabel', '/Enabled', True)
    project.writeEntry('CopyrightLabel', '/Label', ATTRIBUTION)
    metadata = QgsProjectMetadata()
    metadata.setTitle('Blockrand')
    metadata.setAbstract('{{data}}')
    project.setMetadata(metadata)
    folder = os.path.dirname(os.path.abspath(geopackage))
    for entry in LAYERS:
        put(project, project.layerTreeRoot(), entry, folder)
    # Beside the GeoPackage, so that paths are relative.
    handle, written = tempfile.mkstemp(suffix='.qgs', dir=folder)
    os.close(handle)
    try:
        if not project.write(written):
            raise SystemExit(f'QGIS could not write {written}: {project.error()}')
        root = condensed(ElementTree.parse(written).getroot())
    finally:
        for leftover in (written, written + '~'):
            if os.path.exists(leftover):
                os.remove(leftover)
    sorted_attributes(root)
    ElementTree.indent(root, ' ')
    with open(target, 'w', encoding='utf-8', newline='\n') as f:
        f.write("<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n" + ElementTree.tostring(root, 'unicode') + '\n')
    os._exit(0)  # QGIS is known to crash when it is taken down


if __name__ == '__main__':
    if not 2 <= len(sys.argv) <= 3:
        raise SystemExit(__doc__)
    main(sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else os.path.join(FOLDER, 'qgis_project.qgs'))
