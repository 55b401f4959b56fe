# A Cycles reference in which single-sided materials emit from their front alone, as glTF's culling of back faces means
# it and as irad does; Cycles lets both sides of a face emit. Runs the reference tool of ../shared with that one change:
#   blender -b --factory-startup --python-exit-code 1 --python one_sided.py -- TOOL --in SCENE.glb --out OUT [options]
import sys

tool = sys.argv.pop(sys.argv.index('--') + 1)
source = open(tool).read()


def emit_from_the_front():
    """Multiplies the emission strength of every culled material by 1 - Backfacing."""
    import bpy
    for material in bpy.data.materials:
        if not material.use_nodes or not material.use_backface_culling:
            continue
        tree = material.node_tree
        for node in [n for n in tree.nodes if n.bl_idname == 'ShaderNodeBsdfPrincipled']:
            strength = node.inputs['Emission Strength']
            geometry, factor = tree.nodes.new('ShaderNodeNewGeometry'), tree.nodes.new('ShaderNodeMath')
            factor.operation = 'MULTIPLY_ADD'
            factor.inputs[1].default_value, factor.inputs[2].default_value = -strength.default_value, strength.default_value
            tree.links.new(geometry.outputs['Backfacing'], factor.inputs[0])
            tree.links.new(factor.outputs[0], strength)


after_import = source.index('sc = bpy.context.scene')
source = source[:after_import] + 'emit_from_the_front()\n' + source[after_import:]
exec(compile(source, tool, 'exec'))
